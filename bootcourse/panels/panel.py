"""The base class of panels: a column of widgets under a title, with a picture for readers without a kernel.

What a panel shows is computed by functions of the library, and what a user enters is checked by the library, whose
sentence appears in the panel.
"""

import base64
import contextlib
from collections.abc import Callable

import ipywidgets as widgets

from bootcourse import one_per_cell
from bootcourse.colours import ALARM
from bootcourse.errors import BootcourseError
from bootcourse.markup import Markup, html
from bootcourse.panels.page_script import for_everybody
from bootcourse.plots.svg import Drawing, printed

STYLE = """<style>
.bc-panel {border: 1px solid var(--jp-border-color2, #E3E7EB); border-radius: 6px; padding: 10px 14px 12px;
  max-width: 1100px; overflow: hidden; color: var(--jp-ui-font-color1, #1F2933); container-type: inline-size}
.bc-panel h3 {margin: 0 0 2px; font: 650 15px system-ui, sans-serif}
.bc-panel .bc-quiet {font: 12px/1.35 system-ui, sans-serif; color: var(--jp-ui-font-color2, #5F6B77)}
.bc-panel .bc-says {font: 600 13px/1.4 system-ui, sans-serif; min-height: 18px}
.bc-panel .bc-wrong {color: @ALARM@}
.bc-panel svg {display: block; max-width: 100%; height: auto}
@container (max-width: 860px) {  /* a drawing keeps a size that can be read, and its box scrolls */
  .bc-panel .widget-html-content {overflow-x: auto}
  .bc-panel .widget-html-content > svg {max-width: max(100%, var(--least))}
}
.bc-panel .jupyter-widgets-disconnected::before {content: none}  /* one sentence in place of a mark at each part */
.bc-panel.jupyter-widgets-disconnected::before {content: "The kernel has ended: run this cell again."; padding: 0;
  font: 600 13px/1.6 system-ui, sans-serif; color: @ALARM@}
.bc-panel :focus-visible {outline: 2px solid var(--jp-brand-color1, #1976D2); outline-offset: 2px}
.bc-panel .widget-html, .bc-panel .widget-html-content {line-height: normal; height: auto}
</style>""".replace("@ALARM@", ALARM)


class Panel(widgets.VBox):
    """A titled column of widgets. When its notebook cell runs again, the panel is closed.

    `svg` is the drawing that it shows, and `below` what stands under it: what readers without a kernel see.
    """

    svg: Drawing
    below = Markup("")
    closed = False  # of the class: `close` may be called on a panel whose __init__ raised an error

    def __init__(self, title: str, *parts: widgets.Widget):
        self.says = widgets.HTML()
        head = widgets.HTML(Markup(STYLE) + html("<h3>{}</h3>", title) + for_everybody())
        super().__init__([head, *parts, self.says])
        self.add_class("bc-panel")
        one_per_cell.replace_with(self)

    def say(self, sentence: str = "", wrong: bool = False) -> None:
        """Show a message in the panel; an empty one removes it."""
        kind, role = ("bc-says bc-wrong", "alert") if wrong else ("bc-says", "status")
        self.says.value = html('<div class="{}" role="{}">{}</div>', kind, role, sentence) if sentence else ""

    @contextlib.contextmanager
    def saying_what_is_wrong(self):
        """Show a BootcourseError of the block as a message. Any other exception is a bug and passes."""
        try:
            yield
        except BootcourseError as error:
            self.say(str(error), wrong=True)

    def handle(self, action: Callable[[], None]) -> None:
        """Do what a control asks for: in place of the last message, show why it cannot be done."""
        with self.saying_what_is_wrong():
            self.say()
            action()

    def make_button(
        self, label: str, icon: str, help: str, action: Callable[[], None], kind: str = "", width: str = "104px"
    ) -> widgets.Button:
        """A button with its icon and a sentence of help; kind: "" or "primary"."""
        button = widgets.Button(description=label, icon=icon, tooltip=help, button_style=kind, layout={"width": width})
        button.on_click(lambda _: self.handle(action))
        return button

    def update_with(self, *controls: widgets.Widget) -> None:
        """Call the panel's `update` now, and whenever the value of one of these controls changes."""
        for control in controls:
            control.observe(self.update, "value")
        self.update()

    def close(self) -> None:
        """Remove the panel and its parts. Closing twice does nothing."""
        if not self.closed:
            self.closed = True
            one_per_cell.forget(self)
            for part in (*self.children, self.layout):
                _close(part)
            super().close()

    def _repr_mimebundle_(self, **kwargs) -> dict:
        data = base64.b64encode(printed(self.svg)).decode()
        img = html('<img src="data:image/svg+xml;base64,{}" alt="{}" style="max-width:100%">', data, self.svg.alt)
        return super()._repr_mimebundle_(**kwargs) | {"text/html": str(img + self.below), "text/plain": self.svg.alt}


def beside(*parts: widgets.Widget) -> widgets.Box:
    """Parts next to each other, in as many rows as the width needs, each wide enough for its sentence of help."""
    for part in parts:
        part.layout.width, part.layout.flex, part.layout.max_width = "auto", "1 1 420px", "512px"
    return widgets.Box(parts, layout=widgets.Layout(flex_flow="row wrap", grid_gap="6px 32px", margin="6px 0 4px"))


def _close(widget: widgets.Widget) -> None:
    """Close a widget, what is in it, and their layouts and styles, each of which is a widget too."""
    for part in getattr(widget, "children", ()):
        _close(part)
    for name in ("layout", "style"):
        if hasattr(widget, name):
            getattr(widget, name).close()
    widget.close()
