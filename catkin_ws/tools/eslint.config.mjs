// SPDX-License-Identifier: BSD-3-Clause
// What `make lint` asks of the JavaScript; tools/install_others.sh installs eslint into build/lint.

import { createRequire } from "node:module";

const require = createRequire(new URL("../build/lint/", import.meta.url));
const js = require("@eslint/js");
const { browser } = require("globals");

export default [
  js.configs.recommended,
  { languageOptions: { globals: browser } },
  { rules: { "max-lines-per-function": ["error", 40], "max-lines": ["error", 400] } },
  {
    // Sphinx makes the object, and its theme loads jQuery; its pages load the file as a script.
    files: ["**/doc/static/page.js"],
    languageOptions: {
      sourceType: "script",
      globals: { DOCUMENTATION_OPTIONS: "readonly", jQuery: "readonly" },
    },
  },
];
