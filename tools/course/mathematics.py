"""An equation as MathML, which every browser of today draws by itself: no script, no network."""

import re

from latex2mathml.converter import convert


def mathml(latex: str, display: str) -> str:
    """display: inline or block."""
    text = convert(latex, display=display)
    return re.sub(r"(<mi>(?:log|exp|max|min|sin)</mi>)(?!<mo)", r'\1<mspace width="0.17em"/>', text)  # log x, not logx
