"""What the claims of a lesson survived, folded below what it teaches: from `bootcourse.research.claimed`."""

from functools import cache

from bootcourse.research import claimed
from bootcourse.research.claims import of_claim
from bootcourse.research.computed import in_assets
from bootcourse.storage.assets import FOLDER

computed = cache(in_assets)
HEAD = "## What you now know"


@cache
def survived(lesson: str) -> str:
    """A folded list of the lesson's claims with what was tried to refute them, as Markdown; "" where it has none."""
    study = computed(FOLDER)
    made = claimed.claims(study, lesson) if study.experiments.get("stress") else []
    if not made:
        return ""
    parts = [f"**{claim.sentence}**\n\n" + "\n".join(of_claim(claim)) for claim in made]
    summary = "<details><summary>What these claims survived</summary>"
    holds = "*Holds*: the sentence is true there, too."
    return "\n\n".join(["", summary, holds, *(part.strip() for part in parts), "</details>"])
