"""Where a notebook is kept: what it writes lies beside it, in whatever folder its kernel works."""

import os
from pathlib import Path


def beside_the_notebook() -> Path:
    """The folder of this kernel's notebook; the working folder elsewhere, and where nobody says which notebook it is.

    VS Code may start a kernel in the folder that is opened, and tells the notebook's name in a variable; Jupyter's
    server tells it in the environment.
    """
    try:
        from IPython import get_ipython

        shell = get_ipython().kernel.shell
    except (ImportError, AttributeError):  # not in a kernel
        return Path()
    names = (shell.user_ns.get("__vsc_ipynb_file__"), os.environ.get("JPY_SESSION_NAME"))
    folders = [Path(name).parent for name in names if isinstance(name, str) and os.path.isabs(name)]
    here = Path.cwd()
    return next((folder for folder in folders if folder.is_dir() and folder != here), Path())
