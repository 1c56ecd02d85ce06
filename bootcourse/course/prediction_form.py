"""The form of a prediction in a notebook: radio buttons or a field, and a button that commits to the answer.

Without a kernel, or where no widgets are shown, a reader sees the question and its choices.
"""

import ipywidgets as widgets

from bootcourse.course.predictions import Question, commit, committed, predictions, worded
from bootcourse.course.verdict import marked
from bootcourse.markup import Markup, html, joined
from bootcourse.panels.page_script import in_page
from bootcourse.panels.panel import Panel

STYLE = """<style>
.bc-panel .widget-radio-box {height: auto}
.bc-panel .widget-radio-box label {display: flex; flex-direction: row-reverse; justify-content: flex-end; gap: 8px;
  height: auto; margin: 3px 0; line-height: 1.35; white-space: normal; text-align: left}
.bc-panel .widget-radio-box input {flex: none; align-self: flex-start; margin: 0; height: 1.35em; line-height: 1.35}
</style>"""
# JupyterLab would use the arrows, which choose among radio buttons, to go from cell to cell, and Enter to edit a cell.
# Enter in a field commits, once the kernel has what was typed.
KEYS = """
  panel.addEventListener('keydown', event => {
    if (!event.ctrlKey && !event.metaKey && !event.shiftKey) event.stopPropagation();
  });
  panel.addEventListener('keydown', event => {
    if (event.key === 'Enter' && event.target.type === 'text') {
      setTimeout(() => panel.querySelector('button').click(), 300);
    }
  }, true);  // on the way in: the field itself lets no key out
"""
# What answers this prediction is folded in the notebook's file, outputs and text: open it once the form is locked. The
# locked button loses the focus, now or at the browser's next picture, and without it the notebook would hear no key. A
# cell far off screen is not drawn and has no innerText.
UNFOLD = """
  const waits = setInterval(() => {
    if (!panel.isConnected) { clearInterval(waits); return; }
    const button = panel.querySelector('button');
    if (!button?.disabled) return;
    clearInterval(waits);
    const lost = () => [document.body, button].includes(document.activeElement);
    for (const at of ['.jp-Cell', '.jp-Notebook']) {
      if (lost()) panel.closest(at)?.focus({preventScroll: true});
    }
    const asks = cell => [...cell.querySelectorAll('.cm-line')].some(line => /\\bpredict\\(/.test(line.textContent));
    let cell = panel.closest('.jp-Cell')?.nextElementSibling;
    for (; cell && !asks(cell); cell = cell.nextElementSibling) {
      const text = cell.matches('.jp-MarkdownCell') ? cell.querySelector('.jp-InputPlaceholder') : null;
      (cell.querySelector('.jp-OutputPlaceholder') ?? text)?.click();
    }
  }, 200);
"""


class PredictionForm(Panel):
    """Nothing is written before the click. After it, or when an answer is kept already, the form is locked."""

    def __init__(self, question: Question):
        self.question = question
        self.field = self._field()
        help = "Keep this answer, with the time. It cannot be changed."
        self.button = self.make_button("Commit", "check", help, self.commit, "primary")
        # The question stands above, in the lesson and in the call.
        text = widgets.HTML(Markup(STYLE) + in_page(KEYS, "bcForm") + in_page(UNFOLD, "bcUnfold"))
        super().__init__(f"Prediction {question.number}", text, self.field, self.button)
        with self.saying_what_is_wrong():
            entry = predictions().get(question.name)
            if entry is not None:
                self._lock(entry)

    def _field(self) -> widgets.Widget:
        name = f"Prediction {self.question.number}"
        if self.question.choices:
            return widgets.RadioButtons(
                options=self.question.choices, value=None, tooltip=name, layout={"width": "auto"}
            )
        if self.question.unit is not None:
            unit = f" ({self.question.unit})" if self.question.unit else ""
            return widgets.Text(placeholder=f"a number{unit}", tooltip=name, layout={"width": "200px"})
        return widgets.Text(placeholder="your answer", tooltip=name, layout={"width": "auto", "max_width": "640px"})

    def commit(self) -> None:
        """Keep the answer. Raises BootcourseError if it is not accepted."""
        self._lock(commit(self.question, self.field.value))

    def _lock(self, entry: dict) -> None:
        if not self.question.choices:
            self.field.value = worded(entry["answer"])
        elif entry["answer"] in self.question.choices:  # the question may have changed since
            self.field.value = entry["answer"]
        self.field.disabled = self.button.disabled = True
        self.say(committed(entry))

    def _repr_mimebundle_(self, **kwargs) -> dict:
        """The same in every notebook, whatever is kept."""
        by_hand = 'Run this cell to answer. No buttons then? Add answer="…" to the call, and run it again.'
        question = self.question
        choices = joined(html("<li>{}</li>", marked(choice)) for choice in question.choices)
        choices = html("<ul>{}</ul>", choices) if choices else ""
        by_hand = html('<div class="bc-by-hand"><small>{}</small></div>', by_hand)  # the book takes it out
        page = '<div class="bc-prediction"><strong>Prediction {}</strong> {}{}{}</div>'
        page = html(page, question.number, marked(question.text), choices, by_hand)
        text = " / ".join([f"Prediction {question.number}: {question.text}", *question.choices])
        return widgets.VBox._repr_mimebundle_(self, **kwargs) | {"text/html": str(page), "text/plain": text}
