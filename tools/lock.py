"""Write environment.lock and student.lock again: `make lock`.

uv resolves pyproject.toml for every platform at once. Two things are then changed. On Linux torch is
the CPU build, which only torch's own index has, and the CUDA packages that its other build asks for
are left out. student.lock is the part of environment.lock that the lessons need, without the tests and the book.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CUDA = re.compile(r"(nvidia|cuda|triton)\b")
HEADER = """\
# Every package that bootcourse {what}, exact and hashed, for Linux, macOS and Windows.
# Written by `make lock` from pyproject.toml; do not edit. Install it with
#   pip install --no-deps --require-hashes -r {name}
"""

# SHA-256 of torch's CPU wheels, as torch's own index lists them (.../whl/cpu/torch/). A new version
# of torch needs new ones: the check below fails until they are here.
TORCH = "2.13.0"
TORCH_CPU = {
    "cp311 x86_64": "6746dbcbeb526eb61330b76b41ff1b4eb848951103a892eeb080dfa2b264667b",
    "cp312 x86_64": "4ca4a9394b0c771238a4f73590fdbbc4debad85ed0fa63d026ae1b085da7d6e2",
    "cp313 x86_64": "3fbf9c9d1f3c10c2d59d04aca426dee9ccc6ceb32d255c61e93acc3b4f75fae6",
    "cp314 x86_64": "d20fa53ee744502fa4c69818a720b05ca0d37abd055d4f6e66cae155114bc691",
    "cp311 aarch64": "84453b69508ec79902f899c5ed9495acb9e2bbe9fda5f1d5d6f19e3c3842e1a7",
    "cp312 aarch64": "6f307c2c32d764ffc6ff6893b801fad6d4752f3e67966cb8abf1843427c02604",
    "cp313 aarch64": "0b8f7d0423027ae8b90c7977c627f3379f325363a08224dffad9b4b2d684a83d",
    "cp314 aarch64": "ca021f9eb2f8345c83fa03e3a04587308afb8df71bd472670b3ece00df58621c",
}


def resolve(extra: str | None, keep: Path | None = None) -> list[str]:
    """The locked requirements for one extra, or for none, each with its hashes in one string."""
    command = [sys.executable, "-m", "uv", "pip", "compile", "pyproject.toml", "--universal"]
    command += ["--extra", extra] if extra else []
    command += ["--python-version", "3.11", "--generate-hashes", "--no-annotate", "--no-header", "--quiet"]
    command += ["--constraint", str(keep)] if keep else []
    text = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    return re.split(r"\n(?=\w)", text.strip())


def name(requirement: str) -> str:
    return requirement.partition("==")[0]


def pin(requirement: str) -> str:
    """`numpy==2.4.6 ; python_full_version < '3.12'`: the requirement without its hashes."""
    return requirement.partition(" \\\n")[0]


def cpu_torch(requirement: str) -> list[str]:
    """torch's one requirement as two: the CPU build on Linux, the registry's elsewhere."""
    first, *hashes = requirement.split(" \\\n")
    if first != f"torch=={TORCH}":
        raise SystemExit(f"lock.py has the hashes of torch {TORCH}, but pyproject.toml asks for {first}: add its own.")
    on_linux = [f"    --hash=sha256:{digest}" for digest in sorted(TORCH_CPU.values())]
    return [
        " \\\n".join([f"torch=={TORCH}+cpu ; sys_platform == 'linux'", *on_linux]),
        " \\\n".join([f"torch=={TORCH} ; sys_platform != 'linux'", *hashes]),
    ]


def write(path: Path, what: str, requirements: list[str]) -> None:
    path.write_text(HEADER.format(what=what, name=path.name) + "\n".join(requirements) + "\n")
    print(f"{path.name}: {len(requirements)} packages")


def main() -> None:
    locked = []
    for requirement in resolve("test"):
        if name(requirement) == "torch":
            locked += cpu_torch(requirement)
        elif not CUDA.match(requirement):
            locked.append(requirement)
    write(ROOT / "environment.lock", "and its tests need", locked)

    with tempfile.TemporaryDirectory() as folder:
        keep = Path(folder, "keep.txt")
        keep.write_text("\n".join(pin(requirement) for requirement in locked if name(requirement) != "torch"))
        lessons = {name(requirement) for requirement in resolve(None, keep=keep)}
    student = [requirement for requirement in locked if name(requirement) in lessons]
    write(ROOT / "student.lock", "needs for its lessons", student)


if __name__ == "__main__":
    main()
