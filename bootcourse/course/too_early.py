"""A hint below a `NameError` in a notebook: most often the cell that defines the name has not run in this kernel."""

import sys

RUN_ABOVE = "Run > Run All Above Selected Cell"


def hint_at_names() -> None:
    """Add the hint to each `NameError` of this notebook's kernel; elsewhere do nothing."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if hasattr(shell, "kernel"):
        shell.set_custom_exc((NameError,), _show)


def _show(shell, kind, error, trace, tb_offset=None) -> None:
    if error.name:
        error.add_note(
            f"No cell that has run defines `{error.name}`. Run the cells above first ({RUN_ABOVE}), "
            "or look for a typing error."
        )
    shell.showtraceback((kind, error, trace), tb_offset=tb_offset)
