"""What ipywidgets leaves out for readers of the screen and for the keyboard, added in the page itself.

Text that is put into a page runs no <script>: SCRIPT is what an empty image does when it cannot be loaded. It runs in
every view of a panel. Where a page forbids it, the panel works without names.
"""

from bootcourse.markup import Markup, html

SCRIPT = """
const image = this; let tries = 0;
const waiting = setInterval(() => {
  const panel = image.closest('.bc-panel');
  if (!panel) { if (++tries > 200) clearInterval(waiting); return; }
  clearInterval(waiting); image.remove();
  if (panel.dataset.bcNamed) return;
  panel.dataset.bcNamed = '1';
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
}, 50);
"""


def for_everybody() -> Markup:
    """Controls get names, radio buttons arrow keys; a button that switches itself off hands the focus on."""
    return html('<img src="data:," alt="" style="display:none" onerror="{}">', SCRIPT)
