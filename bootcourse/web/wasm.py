"""The compiled road and learner as WebAssembly: numba's own LLVM code, given to LLVM's other back end.

numba writes the code as it stands (no optimisation, no particular processor); LLVM then optimises it for WebAssembly
with vectors of four numbers (simd128). No linker is needed: the object that LLVM emits is a module that a browser
instantiates as it is. What it imports and exports is compared with what the page's script supplies, so that another
numba or llvmlite cannot break the page silently.

    python -m bootcourse.web.wasm road.wasm
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from bootcourse.errors import BootcourseError

# The code must be for no particular processor and not yet optimised, which numba reads when it is imported.
PLAIN = {
    "NUMBA_OPT": "0",
    "NUMBA_CPU_NAME": "generic",
    "NUMBA_CPU_FEATURES": "",
    "NUMBA_LOOP_VECTORIZE": "0",
    "NUMBA_SLP_VECTORIZE": "0",
}
LAYOUT = "e-m:e-p:32:32-p10:8:8-p20:8:8-i64:64-i128:128-n32:64-S128-ni:1:10:20"  # LLVM's, for wasm32-unknown-unknown
FEATURES = "+simd128,+bulk-memory"  # in browsers since 2021, in Safari since 2023
FREE = 65536  # bytes of memory for the module's constants and its stack: behind them lie the page's arrays (road.js)
IMPORTS = {
    "__linear_memory", "__stack_pointer", "asin", "atan", "cos", "exp", "expf", "fmod", "logf", "pow", "sin", "tan"
}  # see road.js  # fmt: skip
# Functions of the learner stay apart. All in one, V8 made of them code that was four times as slow.
APART = "bootcourse5learn8compiled"


def road_module() -> bytes:
    """The module with the functions of `entries.ENTRIES`. Raises BootcourseError if it is not what the page expects."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "road.wasm"
        done = subprocess.run(
            [sys.executable, "-m", "bootcourse.web.wasm", str(path)],
            env={**os.environ, **PLAIN, "NUMBA_CACHE_DIR": folder},
            capture_output=True,
            text=True,
        )
        if done.returncode != 0:
            raise BootcourseError(f"The road did not compile to WebAssembly: {done.stderr.strip()[-2000:]}")
        return path.read_bytes()


def compile_entries() -> bytes:
    """Compile the entries in this process, whose environment must be `PLAIN`: the bytes of the module."""
    import llvmlite.binding as llvm
    import numba

    from bootcourse.web.entries import ENTRIES

    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    whole = None
    for name, (function, kinds) in ENTRIES.items():
        compiled = numba.njit(
            numba.void(*kinds), error_model="numpy", _nrt=False, no_cpython_wrapper=True, no_cfunc_wrapper=True
        )(function)
        (text,), (made,) = compiled.inspect_llvm().values(), compiled.overloads.values()
        text = for_wasm(text, made.fndesc.llvm_func_name, name, 2 + sum(map(arguments, kinds)))
        module = llvm.parse_assembly(text)
        module.verify()
        if whole is None:
            whole = module
        else:
            whole.link_in(module)
    for function in whole.functions:
        if not function.is_declaration and function.name not in ENTRIES:
            function.linkage = "internal"
    return without_notes(optimised(whole))


def optimised(module) -> bytes:
    """An LLVM module optimised for WebAssembly, as an object."""
    import llvmlite.binding as llvm

    machine = llvm.Target.from_triple("wasm32-unknown-unknown").create_target_machine(opt=3, features=FEATURES)
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    options.loop_vectorization = options.slp_vectorization = True
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return machine.emit_object(module)


def without_notes(module: bytes) -> bytes:
    """A module without its sections of number 0, which hold notes for linkers."""
    kept, place = module[:8], 8
    while place < len(module):
        size, start = _number(module, place + 1)
        if module[place] != 0:
            kept += module[place : start + size]
        place = start + size
    return kept


def arguments(kind) -> int:
    """How many machine arguments numba passes for a type: an array is 5 and two for each dimension (see road.js)."""
    return 5 + 2 * kind.ndim if hasattr(kind, "ndim") else 1


def for_wasm(text: str, function: str, name: str, arguments: int) -> str:
    """LLVM code of numba for wasm32: `function`, which has so many arguments, is exported under this name.

    Every function may assume that the memory behind its pointers lies apart, as records and arrays do here: it changes
    nothing through one that it reads through another.
    """
    text = re.sub(r'^target datalayout = ".*"$', f'target datalayout = "{LAYOUT}"', text, flags=re.M)
    text = re.sub(r'^target triple = ".*"$', 'target triple = "wasm32-unknown-unknown"', text, flags=re.M)
    text = re.sub(r"^@\S*NumbaEnv\S* = common .*$\n", "", text, flags=re.M)  # numba's, unused; wasm has no `common`
    defined = re.findall(rf"^define .*@{re.escape(function)}\(.*$", text, flags=re.M)
    if len(defined) != 1 or len(re.findall(r" %[\w.]+(?=[,)])", defined[0])) != arguments:
        raise BootcourseError(
            f"numba compiled '{name}' to {defined}: expected one function of {arguments} arguments (see road.js)."
        )

    def line(found: re.Match) -> str:
        given = re.sub(r"\bptr( noalias)? (?=%arg\.)", "ptr noalias ", found[0])
        if found[0] == defined[0]:
            return re.sub(r"( #\d+)? \{$", f' "wasm-export-name"="{name}" nounwind {{', given)
        return re.sub(r"( #\d+)? \{$", " noinline nounwind {", given) if APART in given else given

    text = re.sub(r"^define .*$", line, text, flags=re.M)
    return re.sub(rf"@{re.escape(function)}\b", f"@{name}", text)


def check(module: bytes, exports: set[str]) -> None:
    """Raise BootcourseError unless the module exports these functions and imports only what the page supplies.

    In a module's lists each name stands behind its length; imports stand behind "env", the module they come from.
    """
    imported = {match[2][: match[1][0]].decode() for match in re.finditer(rb"\x03env(.)(\w+)", module, re.S)}
    absent = {name for name in exports if bytes([len(name)]) + name.encode() + b"\0" not in module}
    if absent or not imported <= IMPORTS or "__linear_memory" not in imported:
        raise BootcourseError(
            f"The road's module lacks the exports {sorted(absent)} and imports {sorted(imported)} (supplied: "
            f"{sorted(IMPORTS)}): numba or llvmlite has changed, so look at bootcourse/web/wasm.py."
        )
    end = data_end(module)
    if end > FREE:
        raise BootcourseError(
            f"The road's module has constants up to byte {end} of its memory, and the page's arrays begin at {FREE}: "
            "raise FREE in bootcourse/web/wasm.py."
        )


def data_end(module: bytes) -> int:
    """The first byte of memory behind the constants of a module, 0 without any.

    Of the format (https://webassembly.github.io/spec/core/binary) it reads the section of data alone, number 11. Raises
    BootcourseError for data whose place is not a plain number.
    """
    end, place = 0, 8
    while place < len(module):
        kind, (size, start) = module[place], _number(module, place + 1)
        place = start + size
        if kind != 11:
            continue
        count, here = _number(module, start)
        for _ in range(count):
            if module[here : here + 2] != b"\x00\x41":  # in memory 0, from a constant on
                raise BootcourseError(
                    "The road's module places its constants in a new way: look at bootcourse/web/wasm.py."
                )
            first, here = _number(module, here + 2)
            length, here = _number(module, here + 1)  # behind the mark of the end of the place
            here += length
            end = max(end, first + length)
    return end


def _number(module: bytes, place: int) -> tuple[int, int]:
    """A number in LEB128, seven bits a byte, and the place behind it."""
    value, shift = 0, 0
    while True:
        byte = module[place]
        value, shift, place = value | (byte & 127) << shift, shift + 7, place + 1
        if byte < 128:
            return value, place


if __name__ == "__main__":
    Path(sys.argv[1]).write_bytes(compile_entries())
