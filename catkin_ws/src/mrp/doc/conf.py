# SPDX-License-Identifier: BSD-3-Clause
"""The site's configuration: `make docs` builds it."""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent / "extension"))

project = "mrp"
author = "The mrp maintainers"
copyright = "The mrp maintainers. Text: CC BY 4.0"

extensions = [
    "sphinx_inline_tabs",
    "sphinx_copybutton",
    "sphinx_design",
    "source_code",
    "value",
    "terminal",
    "proofs",
    "listing",
    "picture",
    "error_texts",
    "contract_keys",
    "quiz",
]

html_theme = "furo"
html_title = "ROS 1 on Debian: publish and subscribe"
html_theme_options = {"top_of_page_buttons": []}
html_static_path = ["static"]
html_css_files = ["page.css"]
html_js_files = ["page.js"]
html_favicon = "static/icon.svg"
html_show_sourcelink = False
_manifest = (pathlib.Path(__file__).parents[1] / "package.xml").read_text()
version = re.search("<version>(.*)</version>", _manifest)[1]
html_last_updated_fmt = f"%Y-%m-%d, version {version}"
# In a release, package.xml has the site's address: then each page has a description for search
# engines, and sitemap.xml lists them all.
if website := re.search('<url type="website">(.*)</url>', _manifest):
    html_baseurl = ogp_site_url = website[1] + "/"
    extensions += ["sphinx_sitemap", "sphinxext.opengraph"]
    sitemap_url_scheme = "{link}"
    ogp_social_cards = {"enable": False}
html_show_sphinx = False
# What was printed is there to be read, not to be typed.
copybutton_selector = "div:not(.output) > div.highlight pre"

# A link that leads nowhere is an error, as is everything that Sphinx warns of: it is run with -W.
nitpicky = True


def setup(app):
    """In a release, the pages name its repository where the sources have OWNER/REPO."""
    repository = re.search('<url type="repository">.*/(.*)/(.*)</url>', _manifest)
    if not repository:
        return
    owner, name = repository.groups()

    def name_repository(app, page, source):
        text = source[0].replace("OWNER/REPO", f"{owner}/{name}").replace("1.0.0", version)
        source[0] = text.replace("ghcr.io/OWNER", f"ghcr.io/{owner.lower()}")

    app.connect("source-read", name_repository)
