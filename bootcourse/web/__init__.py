"""The page that drives: the compiled road as WebAssembly, in one HTML file that needs neither installation nor network.

`python -m bootcourse.web.build --out trap.html` writes it.
"""
