"""Equations as MathML, set while the site is built.

Browsers draw it without a script; LaTeX that cannot be read is an error of the build.
"""

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

TAG = re.compile(r"\\tag\{(\w+)\}")
TIGHT = re.compile("<mo([^>]*)>([|‖/])</mo>")
"""The bars of magnitudes, and the slash: browsers leave more space on both sides than LaTeX does."""
LOOSE = re.compile(r"<mo>&ApplyFunction;</mo>(?!\s*<mo[^>]*>\()")
"""Between a function's name and what it is of, without parentheses: browsers leave no space there."""


def setup(app: Sphinx) -> dict[str, Any]:
    """Make this the renderer of the name `mathml`."""
    app.add_html_math_renderer("mathml", (_inline, None), (_displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(_set(node.astext(), node, as_block=False))
    raise nodes.SkipNode


def _displayed(writer: Any, node: nodes.math_block) -> None:
    """An equation on a line of its own, with its number, which a link `#equation-N` finds."""
    latex = node.astext()
    numbers = TAG.findall(latex)
    writer.body.append(
        f'<div class="equation" id="equation-{numbers[0]}">' if numbers else '<div class="equation">'
    )
    writer.body.append(_set(TAG.sub("", latex), node, as_block=True))
    writer.body.extend(f'<span class="eqno">({number})</span>' for number in numbers)
    writer.body.append("</div>\n")
    raise nodes.SkipNode


def _set(latex: str, node: nodes.Node, as_block: bool) -> str:
    try:
        if latex.count("{") != latex.count("}"):
            raise MathError("Braces do not match.")  # which the converter lets pass
        mathml = TIGHT.sub(r'<mo\1 lspace="0" rspace="0">\2</mo>', tex2mathml(latex, as_block=as_block))
        return LOOSE.sub('<mspace width="0.17em"></mspace>', mathml)
    except MathError as error:
        logging.getLogger(__name__).warning("%s cannot be set: %s", latex.strip(), error, location=node)
        return ""
