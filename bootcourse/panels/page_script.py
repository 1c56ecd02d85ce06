"""Scripts of panels, and what ipywidgets leaves out for readers of the screen and for the keyboard.

Text that is put into a page runs no <script>, and a JavaScript output would stay in the saved notebook without its
panel. A script here is what an empty image does when it cannot be loaded: it runs in every view of a panel. Where a
page forbids it, the panel works without.
"""

from bootcourse.markup import Markup, html

WAIT = """
const image = this; let tries = 0;
const waiting = setInterval(() => {
  const panel = image.closest('@PLACE@');
  if (!panel) { if (++tries > 200) clearInterval(waiting); return; }
  clearInterval(waiting); image.remove();
  if (panel.dataset.@MARK@) return;
  panel.dataset.@MARK@ = '1';
  @SCRIPT@
}, 50);
"""
NAMES = """
  let last = null;
  const all = selector => [...panel.querySelectorAll(selector)];
  const name = (element, words) => {
    if (element && element.getAttribute('aria-label') !== words) element.setAttribute('aria-label', words);
  };
  const mend = () => {
    for (const label of all('.widget-label[title]:not([title=null])')) {
      name(label.parentElement.querySelector('[role=slider], input[type=number], .widget-radio-box'), label.title);
    }
    for (const field of all('input[type=text][title]')) name(field, field.title);
    for (const button of all('button')) {  // a name in letters, and not an arrow or an icon's own sign
      name(button, /\\p{Ll}/u.test(button.textContent) ? button.textContent.replace(/^[^\\p{L}]+/u, '') : button.title);
    }
    for (const [i, box] of all('.widget-radio-box').entries()) {  // one stop for Tab, and arrows inside
      box.setAttribute('role', 'radiogroup');
      for (const choice of box.querySelectorAll('input')) choice.name = `${box.getAttribute('aria-label')} ${i}`;
    }
    setTimeout(handOver, 100);  // the browser takes the focus away a little later
  };
  const handOver = () => {
    if (!last?.disabled || document.activeElement !== document.body) return;
    panel.querySelector('button:not(:disabled)')?.focus({preventScroll: true});
  };
  panel.addEventListener('focusin', event => { last = event.target; });
  panel.addEventListener('focusout', event => { if (!event.target.disabled) last = null; });
  new MutationObserver(mend).observe(
    panel, {subtree: true, childList: true, attributes: true, attributeFilter: ['disabled', 'title']});
  mend();
"""


def in_page(script: str, mark: str, place: str = ".bc-panel") -> Markup:
    """Run a script once in each view of the element around it that the selector `place` names, there called `panel`.

    mark: the name, of its own, under which the element notes that the script has run.
    """
    whole = WAIT.replace("@PLACE@", place).replace("@MARK@", mark).replace("@SCRIPT@", script)
    return html('<img src="data:," alt="" style="display:none" onerror="{}">', whole)


def for_everybody() -> Markup:
    """Controls get names, radio buttons arrow keys; a button that switches itself off hands the focus on."""
    return in_page(NAMES, "bcNamed")
