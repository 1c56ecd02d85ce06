"""Learning on another device: on a GPU where there is one, as on the CPU; and what is refused where there is none."""

import numpy as np
import pytest
import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.storage.checkpoint import DamagedCheckpoint, load_checkpoint, save_checkpoint

SMALL = {"hidden": (8,), "envs_per_agent": 4, "demonstration_episodes": 1}
ON_POLICY = {"horizon": 3, "batch": 12, "epochs": 1}


def updated(method: str, device: str = "cpu") -> Training:
    """Two agents of a method after some updates, within 6 decisions."""
    changes = SMALL | (ON_POLICY if METHODS[method].on_policy else {"learning_starts": 8, "batch": 16})
    training = Training(with_seeds(settings_for(method, **changes), 2), 100, device=device)
    for _ in range(6):
        training.step()
    return training


def test_a_device_that_torch_does_not_find_is_named_and_a_checkpoint_is_not_called_damaged_for_it(tmp_path):
    for name in ("cuda:99", "a potato"):
        with pytest.raises(BootcourseError, match=f"'{name}'.*Give \"cpu\""):
            Training([settings_for("sac")], device=name)
    save_checkpoint(updated("sac"), tmp_path / "checkpoint.npz")
    with pytest.raises(BootcourseError, match="^device = 'cuda:99'") as refused:
        load_checkpoint(tmp_path / "checkpoint.npz", device="cuda:99")
    assert not isinstance(refused.value, DamagedCheckpoint)


@pytest.mark.parametrize("method", METHODS)
def test_a_default_type_that_somebody_gave_torch_changes_nothing(method):
    usual = updated(method)
    torch.set_default_dtype(torch.float64)
    try:
        other = updated(method)
    finally:
        torch.set_default_dtype(torch.float32)
    assert usual.updates == other.updates > 0 and usual.losses
    for name, loss in usual.losses.items():
        assert other.losses[name].dtype == loss.dtype and torch.equal(other.losses[name], loss), name


@pytest.mark.skipif(not torch.cuda.is_available(), reason="there is no CUDA device")
def test_every_method_learns_on_a_gpu_and_goes_on_there(tmp_path):
    for method in METHODS:
        here, there = updated(method), updated(method, "cuda")
        assert here.updates == there.updates > 0, method
        save_checkpoint(here, tmp_path / f"{method}.npz")
        moved = load_checkpoint(tmp_path / f"{method}.npz", device="cuda")
        for each in (here, there, moved):
            each.step()
        losses = [np.array([each.losses[name].cpu().numpy() for name in here.losses]) for each in (here, there, moved)]
        for other in losses[1:]:
            assert np.allclose(losses[0], other, rtol=0.1, atol=0.1), method
