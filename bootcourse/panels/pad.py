"""Nine buttons and the arrow keys; one press is one action.

ipywidgets has no key events. A script beside the buttons (see page_script.py) listens for the arrow keys and clicks the
button that they stand for. Where a page forbids it, the buttons still work with Tab and Enter.
"""

from collections.abc import Callable

import ipywidgets as widgets

from bootcourse.markup import Markup, html
from bootcourse.panels.page_script import in_page
from bootcourse.scenario import ACTION_NAMES

SIGNS = ("↙", "↓", "↘", "←", "•", "→", "↖", "↑", "↗")  # in the order of ACTION_NAMES
ROWS = ((6, 7, 8), (3, 4, 5), (0, 1, 2))  # on the page: accelerate on top, as the arrow up
TOGETHER, REPEAT = 60, 400  # ms: keys pressed this close together are one action; a held key acts again after that

# `data-lm-suppress-shortcuts` keeps JupyterLab from using the arrow keys to go from cell to cell.
SCRIPT = """
  panel.setAttribute('data-lm-suppress-shortcuts', 'true');
  const held = new Set(), names = {ArrowUp: 1, ArrowDown: 1, ArrowLeft: 1, ArrowRight: 1};
  let wanted = 4, soon = null, again = null;
  const meant = () => 3 * (1 + held.has('ArrowUp') - held.has('ArrowDown'))
    + 1 + held.has('ArrowRight') - held.has('ArrowLeft');
  const press = () => { soon = null; const b = panel.querySelector('.bc-pad-' + wanted); if (b) b.click(); };
  const calm = () => { held.clear(); clearInterval(again); again = null; };
  panel.addEventListener('keydown', event => {
    const space = event.key === ' ' && event.target.classList.contains('bc-keys');
    if (event.ctrlKey || event.altKey || event.metaKey || !(event.key in names || space)) return;
    event.preventDefault(); event.stopPropagation();
    if (event.repeat) return;
    if (!space) held.add(event.key);
    wanted = space ? 4 : meant();
    if (soon === null) soon = setTimeout(press, @TOGETHER@);
    clearInterval(again);
    again = space ? null : setInterval(() => { wanted = meant(); press(); }, @REPEAT@);
  });
  panel.addEventListener('keyup', event => { held.delete(event.key); if (!held.size) calm(); });
  panel.addEventListener('focusout', calm);
""".replace("@TOGETHER@", str(TOGETHER)).replace("@REPEAT@", str(REPEAT))

STYLE = """<style>
.bc-keys {border: 1px dashed var(--jp-border-color1, #B6BEC7); border-radius: 4px; padding: 5px 8px; cursor: pointer;
  font: 12px/1.35 system-ui, sans-serif; color: var(--jp-ui-font-color2, #5F6B77)}
.bc-panel .bc-keys:focus {outline: 2px solid var(--jp-brand-color1, #1976D2); outline-offset: 1px; border-style: solid;
  color: var(--jp-ui-font-color1, #1F2933)}
.bc-drive button.jupyter-button {font-size: 17px; line-height: 1; padding: 0}
</style>"""


class Pad(widgets.VBox):
    """Nine buttons; `press(action)` is called for a click and for the arrow keys that stand for the button."""

    def __init__(self, press: Callable[[int], None]):
        self.buttons = []
        for action, sign in enumerate(SIGNS):
            button = widgets.Button(description=sign, tooltip=ACTION_NAMES[action])
            button.layout.width, button.layout.height = "66px", "36px"
            button.add_class(f"bc-pad-{action}")
            button.on_click(lambda _, action=action: press(action))
            self.buttons.append(button)
        rows = [widgets.HBox([self.buttons[action] for action in row]) for row in ROWS]
        help = "Click here, then drive with the arrow keys: ↑ accelerates, ↓ brakes, ← → steer, Space keeps straight."
        page = '<div class="bc-keys" tabindex="0" role="application" aria-label="{help}">{help}</div>'
        keys = Markup(STYLE) + html(page, help=help) + in_page(SCRIPT, "bcKeys", ".bc-drive")
        super().__init__([*rows, widgets.HTML(keys, layout={"width": "206px"})])
        self.layout.width = "220px"
        self.add_class("bc-drive")
