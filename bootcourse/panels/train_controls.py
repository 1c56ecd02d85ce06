"""The numbers of the training panel, one for each setting, and why a setting has no effect in some methods."""

from dataclasses import replace

from bootcourse.learn.settings import Settings, settings_for
from bootcourse.methods import METHODS, display_name
from bootcourse.panels.number import Number

CONTROLLED = ("rule_p", "xi_multiplier", "bonus", "beta_start", "gamma")


def without(method: str) -> dict[str, str]:
    """Why a method has no use for a setting: {setting: sentence}. What is not in it can be chosen."""
    own, called = METHODS[method].settings, display_name(method)
    reasons = {}
    if own.get("xi_multiplier") == 0:
        reasons["xi_multiplier"] = f"Without use: {called} has no soft constraint."
        if "rule_p" not in own:  # a method that uses π̃ in another way names its p
            reasons["rule_p"] = f"Without use: {called} has no KL to the stochastic rule."
    if own.get("bonus") == 0:
        reasons["bonus"] = f"Without use: {called} adds no bonus to demonstrations."
    if own.get("beta_start") == 0:
        reasons["beta_start"] = f"Without use: {called} sees no demonstrations."
        reasons["bonus"] = reasons["beta_start"]
    if "beta_episodes" in own:
        reasons["beta_start"] = f"Fixed: {called} learns from the same share to the end."
    return reasons | {name: f"Without use: {called} {why}." for name, why in METHODS[method].unused.items()}


def numbers_for(changes: dict) -> dict[str, Number]:
    """One for each setting that the panel offers, checked as the library checks it; changes: of the paper's values."""
    start = replace(Settings(), **{name: value for name, value in changes.items() if name in CONTROLLED})

    def checked(setting):
        return lambda value: settings_for("bootstrapped", **{setting: value})

    return {
        "rule_p": Number("p", start.rule_p, 0.12, 0.999, 0.001, "How sure the stochastic rule π̃ is of its own action.",
                    check=checked("rule_p")),
        "xi_multiplier": Number("ξ", start.xi_multiplier, 0, 2000, 10, "Strength of the pull towards the rule.",
                                unit="× α", check=checked("xi_multiplier")),
        "bonus": Number("c", start.bonus, 0, 10, 0.1, "Bonus on a demonstrated action's reward.",
                        check=checked("bonus")),
        "beta_start": Number("β", start.beta_start, 0, 1, 0.05, "Share of demonstrations in a batch, at first.",
                             check=checked("beta_start")),
        "gamma": Number("γ", start.gamma, 0, 1, 0.01, "Discount: how much the next second counts.",
                        check=checked("gamma")),
    }  # fmt: skip
