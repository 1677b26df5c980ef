"""The documentation site: the pages in this folder, and docstrings of what imports without Blender.

`make docs` builds it; a warning is an error. The sources are read as they are, too: so pages keep to
CommonMark, tables, mathematics and links between files.
"""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

project = "RSIBR Reflection Maps"
author = "The RSIBR authors"
copyright = "the RSIBR authors, GPL-3.0-or-later"
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "theme.mathml",
    "theme.references",
    "theme.rooms",
]
exclude_patterns = ["theme"]
language = "en"

# Pages
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 3
myst_links_external_new_tab = False
suppress_warnings = ["misc.highlighting_failure"]  # JSON that is shortened with "..."

# Docstrings
autodoc_member_order = "bysource"
autodoc_typehints = "signature"  # docstrings tell what annotations cannot: shapes, units, ranges, errors
autodoc_default_options = {"members": True}
default_role = "code"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_param = False
napoleon_custom_sections = [
    ("Attributes", "params_style")
]  # else names in types become links, to anything of that name
python_use_unqualified_type_names = True
add_module_names = False
toc_object_entries_show_parents = "hide"

# Looks
html_theme = "furo"
html_title = "RSIBR"
html_static_path = ["theme/static"]
html_css_files = ["site.css"]
html_copy_source = False
html_math_renderer = "mathml"
