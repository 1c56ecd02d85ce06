"""The world: the compiled road as WebAssembly, to look at and to drive; `mount.js` puts it into an element of any page.

`page.html` is the page that shows it and nothing else, in one file that needs neither installation nor network:

`python -m bootcourse.web.build --out trap.html` writes it.
"""
