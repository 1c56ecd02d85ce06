"""Learning on another device. A GPU is rarely at hand, so most of this uses a pretended one: torch's "meta" device.

A tensor that is elsewhere has its numbers on the CPU. As on a GPU, it cannot become a NumPy array, and no operation
takes it together with a tensor of the CPU, but for copies and indices.
"""

import numpy as np
import pytest
import torch
from torch.utils._python_dispatch import TorchDispatchMode
from torch.utils._pytree import tree_leaves, tree_map

from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.storage.checkpoint import DamagedCheckpoint, load_checkpoint, save_checkpoint

ELSEWHERE = "meta"
BOTH_DEVICES = ("aten::copy_", "aten::_to_copy", "aten::index", "aten::index_put_")  # the first argument decides


class ElsewhereTensor(torch.Tensor):
    """A tensor on the pretended device, with its numbers `inner` on the CPU."""

    __torch_function__ = torch._C._disabled_torch_function_impl

    @staticmethod
    def __new__(cls, inner):
        kind = {"strides": inner.stride(), "storage_offset": inner.storage_offset(), "dtype": inner.dtype}
        return torch.Tensor._make_wrapper_subclass(cls, inner.shape, device=ELSEWHERE, **kind)

    def __init__(self, inner):
        self.inner = inner

    @classmethod
    def __torch_dispatch__(cls, func, types, args=(), kwargs=None):
        with PretendedDevice():
            return func(*args, **(kwargs or {}))


class PretendedDevice(TorchDispatchMode):
    """What is asked of the device "meta" is computed on the CPU."""

    def __torch_dispatch__(self, func, types, args=(), kwargs=None):
        kwargs, name = dict(kwargs or {}), func._schema.name
        tensors = [each for each in tree_leaves((args, kwargs)) if isinstance(each, torch.Tensor)]
        away = [isinstance(each, ElsewhereTensor) for each in tensors]
        here = [each for each in tensors if not isinstance(each, ElsewhereTensor) and each.dim()]
        if any(away) and here and name not in BOTH_DEVICES:
            raise AssertionError(f"{name} takes tensors of two devices: move {[tuple(each.shape) for each in here]}.")
        asked = kwargs.get("device")
        if asked is not None:
            kwargs["device"] = torch.device("cpu")
        bare = tree_map(lambda each: each.inner if isinstance(each, ElsewhereTensor) else each, (args, kwargs))
        result = func(*bare[0], **bare[1])
        if name.endswith("_"):  # it has changed its first argument
            return None if result is None else args[0]
        there = torch.device(asked).type == ELSEWHERE if asked is not None else any(away)
        return tree_map(
            lambda each: ElsewhereTensor(each) if there and isinstance(each, torch.Tensor) else each, result
        )


@pytest.fixture
def pretended(monkeypatch):
    """The pretended device; Adam's fused step exists on real devices alone."""
    adam = torch.optim.Adam
    monkeypatch.setattr(torch.optim, "Adam", lambda groups, fused=None, **more: adam(groups, **more))
    with PretendedDevice():
        yield ELSEWHERE


SMALL = {"hidden": (8,), "envs_per_agent": 4, "demonstration_episodes": 1}
ON_POLICY = {"horizon": 3, "batch": 12, "epochs": 1, "cloning_updates": 2}


def small_training(method, device="cpu"):
    """Two agents of a method that make some updates within 6 decisions."""
    on_policy = METHODS[method].on_policy
    changes = SMALL | (ON_POLICY if on_policy else {"learning_starts": 8, "batch": 16})
    if on_policy and not settings_for(method).needs_demonstrations:
        changes |= {"cloning_updates": 0}
    return Training(with_seeds(settings_for(method, **changes), 2), 100, device=device)


def after(training, decisions=6):
    """The training, so many decisions on each road later."""
    for _ in range(decisions):
        training.step()
    return training


EACH_LEARNER = {METHODS[method].learner: method for method in METHODS}  # one method of each


@pytest.mark.parametrize("method", EACH_LEARNER.values())
def test_a_method_learns_the_same_on_another_device(method, pretended):
    here, elsewhere = after(small_training(method)), after(small_training(method, pretended))
    assert here.updates == elsewhere.updates > 0
    moved = [each for each in tree_leaves(elsewhere.learner.tensors()) if each.dim()]
    assert {each.device.type for each in moved} == {pretended}
    for mine, theirs in zip(here.result().agents, elsewhere.result().agents, strict=True):
        for a, b in zip([*mine.actor, *mine.critics], [*theirs.actor, *theirs.critics], strict=True):
            assert np.allclose(a.numpy(), b.numpy(), atol=1e-6)


@pytest.mark.parametrize("method", ["bootstrapped", "ppo_cloned"])
def test_a_training_goes_on_on_another_device(method, pretended, tmp_path):
    training = after(small_training(method))
    save_checkpoint(training, tmp_path / "checkpoint.npz")
    moved = load_checkpoint(tmp_path / "checkpoint.npz", device=pretended)
    after(training), after(moved)
    for a, b in zip(training.agent(1).actor, moved.agent(1).actor, strict=True):
        assert np.allclose(a.numpy(), b.numpy(), atol=1e-6)
    save_checkpoint(moved, tmp_path / "moved.npz")
    assert load_checkpoint(tmp_path / "moved.npz").updates == training.updates


def test_a_device_that_torch_does_not_find_is_named_and_a_checkpoint_is_not_called_damaged_for_it(tmp_path):
    for name in ("cuda:99", "tpu", "a potato"):
        with pytest.raises(BootcourseError, match=f"'{name}'.*Give \"cpu\""):
            Training([settings_for("sac")], device=name)
    save_checkpoint(small_training("sac"), tmp_path / "checkpoint.npz")
    with pytest.raises(BootcourseError, match="^device = 'cuda:99'") as refused:
        load_checkpoint(tmp_path / "checkpoint.npz", device="cuda:99")
    assert not isinstance(refused.value, DamagedCheckpoint)


@pytest.mark.skipif(not torch.cuda.is_available(), reason="there is no CUDA device")
def test_every_method_learns_on_a_gpu():
    for method in METHODS:
        here, there = after(small_training(method)), after(small_training(method, "cuda"))
        assert here.updates == there.updates > 0, method
        losses = [np.array([each.losses[name].cpu().numpy() for name in here.losses]) for each in (here, there)]
        assert np.allclose(*losses, rtol=0.1, atol=0.1), method
