"""What only the notebooks need: to show the library's own source, live curves, small figures."""

import importlib
import inspect


def source(module: str, *names: str):
    """The library's own code of some functions, as a notebook output: what you read is what runs."""
    from IPython.display import Code

    functions = [getattr(importlib.import_module(module), name) for name in names]
    plain = [getattr(function, "py_func", function) for function in functions]  # a compiled function holds its Python
    return Code("\n\n".join(inspect.getsource(function).rstrip() for function in plain), language="python")
