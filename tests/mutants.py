"""Wrong answers made by machine: each solution is changed in one place, and the check must refuse it.

    python -m tests.mutants critic_target mixed_batch  # the changes to their solutions that pass: cases are missing

A change that gives the right answer for all arguments that the exercise allows is no mistake: it stands in
the lesson's answers.py, with the reason, as `equivalent(exercise, change, why)`. Classes are left out, and exercises in
which other numbers do as well: most changes to a controller are other controllers, and a probe may ask with any.
"""

import ast
import copy
import inspect
import signal
import sys
import textwrap
import warnings
from collections.abc import Callable, Iterator

import numpy as np
import torch

from bootcourse.course.exercise import Exercise, call_it
from bootcourse.course.judge import outcomes
from bootcourse.course.lessons import registry
from bootcourse.course.values import fitted, plain, same

FREE = ("find_plan", "my_rule", "watchful_rule", "unmasks")
SECONDS = 2  # of the processor, for all cases of one change
COMPARED = {ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq}
OPPOSITE = {ast.Gt: ast.Lt, ast.GtE: ast.LtE, ast.Lt: ast.Gt, ast.LtE: ast.GtE}
OPERATION = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Div,
             ast.Pow: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd, ast.And: ast.Or,
             ast.Or: ast.And}  # fmt: skip
RENAMED = {"mean": "sum", "sum": "mean", "max": "min", "min": "max", "amax": "amin", "amin": "amax", "any": "all",
           "all": "any", "argmax": "argmin", "argmin": "argmax", "ceil": "floor", "floor": "ceil", "exp": "expm1",
           "log": "log1p", "zeros": "ones", "ones": "zeros", "zeros_like": "ones_like", "prod": "sum",
           "log_softmax": "softmax", "softmax": "log_softmax", "maximum": "minimum", "minimum": "maximum",
           "percentile": "quantile", "detach": "clone"}  # fmt: skip

CASTS = ("float", "array", "asarray", "clone", "detach", "to", "astype", "double")  # dropped, they change no value
SYMMETRIC = ("max", "min", "maximum", "minimum")


def changes(node: ast.AST, first: dict) -> Iterator[ast.AST]:
    """What may stand in a node's place. first: the arguments of the first case, by name."""
    match node:
        case ast.Constant(value=bool() as value):
            yield ast.Constant(not value)
        case ast.Constant(value=int() as value):
            yield from map(ast.Constant, (value - 1, value + 1))
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() as value)):  # an axis, or the end of a slice
            yield from map(ast.Constant, (-value - 1, -value + 1))
        case ast.Constant(value=float() as value):
            yield from map(ast.Constant, sorted({value * 1.01, value + 0.1, -value} - {value}))
        case ast.Compare(ops=[op], left=left, comparators=[right]):
            for others in (COMPARED, OPPOSITE):
                if type(op) in others:
                    yield ast.Compare(left, [others[type(op)]()], [right])
        case ast.BinOp(op=op) | ast.BoolOp(op=op) if type(op) in OPERATION:
            changed = copy.deepcopy(node)
            changed.op = OPERATION[type(op)]()
            yield changed
        case ast.UnaryOp(op=ast.USub() | ast.Not() | ast.Invert(), operand=operand):
            yield operand
        case ast.IfExp(test=test, body=body, orelse=orelse):
            yield from (body, orelse, ast.IfExp(test, orelse, body))
        case ast.Call(func=func, args=args):
            name = func.attr if isinstance(func, ast.Attribute) else getattr(func, "id", "")
            if name in RENAMED:
                changed = copy.deepcopy(node)
                key = "attr" if isinstance(func, ast.Attribute) else "id"
                setattr(changed.func, key, RENAMED[name])
                yield changed
            for k in range(len(args) - 1) if name not in SYMMETRIC else ():  # two arguments swapped
                changed = copy.deepcopy(node)
                changed.args[k : k + 2] = reversed(changed.args[k : k + 2])
                yield changed
            if args and name not in CASTS and not isinstance(args[0], ast.Starred):  # f(x) becomes x
                yield args[0]
            if isinstance(func, ast.Attribute) and name not in CASTS:  # x.f() becomes x
                yield func.value
            for k in range(len(node.keywords)) if "device" not in [each.arg for each in node.keywords] else ():
                changed = copy.deepcopy(node)
                del changed.keywords[k]
                yield changed
        case ast.Slice(lower=lower, upper=upper, step=step):
            if lower or upper:
                yield ast.Slice(lower and None, upper, step)
                yield ast.Slice(lower, upper and None, step)
        case ast.Return(value=ast.expr() as value):
            if not isinstance(value, ast.Constant):
                yield ast.Return(ast.UnaryOp(ast.USub(), value))
            for method in ("detach", "item") if first["slopes"] else ():
                yield ast.Return(ast.Call(ast.Attribute(value, method, ast.Load()), [], []))
        case ast.If(test=test, body=body, orelse=orelse):
            yield ast.If(ast.Constant(True), body, orelse)
            yield ast.If(ast.Constant(False), body, orelse)
        case ast.Assign() | ast.AugAssign() | ast.Expr():
            yield ast.Pass()
    if isinstance(node, (ast.Name, ast.Attribute)) and isinstance(node.ctx, ast.Load):
        value = value_of(node, first)
        if isinstance(node, ast.Name) and node.id in first["slopes"]:
            yield ast.Call(ast.Attribute(node, "detach", ast.Load()), [], [])
        if isinstance(value, (bool, int, float, np.number)):  # hard-coded
            yield ast.Constant(value.item() if isinstance(value, np.generic) else value)


def value_of(node: ast.AST, first: dict):
    """The first case's value of an argument, or of an attribute of one; None for all else."""
    if isinstance(node, ast.Name):
        return first.get(node.id)
    if isinstance(node, ast.Attribute):
        return getattr(value_of(node.value, first), node.attr, None)
    return None


def mutants(exercise: Exercise) -> Iterator[tuple[str, Callable]]:
    """(what was changed, the changed function) for every place of the solution's code."""
    solution = getattr(exercise.solution, "py_func", exercise.solution)
    tree = ast.parse(textwrap.dedent(inspect.getsource(solution)))
    if not isinstance(tree.body[0], ast.FunctionDef):
        return
    function = tree.body[0]
    function.decorator_list = []
    function.returns = None
    for argument in (*function.args.args, *function.args.kwonlyargs):
        argument.annotation = None
    arguments = [a.arg for a in function.args.args]
    first = dict(zip(arguments, exercise.all_arguments[0], strict=False)) if exercise.run is call_it else {}
    first["slopes"] = exercise.slopes
    space = solution.__globals__
    seen = {ast.unparse(function)}
    parents = {}
    for parent, name, place, node in places(function):
        parents[node] = parent
        around = parent
        while isinstance(around, (ast.keyword, ast.UnaryOp, ast.Slice, ast.Attribute)):
            around = parents[around]
        before = first_line(node if around is function else around)
        for other in changes(node, first):
            put(parent, name, place, other)
            ast.fix_missing_locations(tree)
            text = ast.unparse(function)
            if text not in seen and "detach().detach()" not in text:
                seen.add(text)
                after = first_line(other if around is function else around)
                yield f"{before}  ->  {after}", compiled(text, function.name, space)
            put(parent, name, place, node)
    for (case, _), right in zip(exercise.worked, outcomes(exercise, exercise.solution), strict=False):
        value = right.data[0] if exercise.slopes else right
        if value.kind in ("tensor", "array", "number"):
            back = torch.tensor(value.data) if value.kind == "tensor" else np.array(value.data)
            yield f"the printed example's answer, {len(case)} arguments", lambda *arguments, back=back: back


def first_line(node: ast.AST) -> str:
    return ast.unparse(node).partition("\n")[0]


def places(function: ast.FunctionDef) -> list[tuple[ast.AST, str, int | None, ast.AST]]:
    """(parent, field, index, node) of every node in the function's body but its docstring."""
    found, todo = [], [(function, "body", k, node) for k, node in enumerate(function.body)]
    while todo:
        found.append(todo.pop(0))
        parent = found[-1][3]
        if isinstance(parent, ast.UnaryOp) and isinstance(parent.operand, ast.Constant):
            continue  # a negative number is one place
        for name, value in ast.iter_fields(parent):
            if isinstance(value, ast.AST):
                todo.append((parent, name, None, value))
            elif isinstance(value, list):
                todo += [(parent, name, k, each) for k, each in enumerate(value) if isinstance(each, ast.AST)]
    return [each for each in found if not is_docstring(each[3])]


def is_docstring(node: ast.AST) -> bool:
    value = node.value if isinstance(node, ast.Expr) else node
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def put(parent: ast.AST, name: str, place: int | None, node: ast.AST) -> None:
    if place is None:
        setattr(parent, name, node)
    else:
        getattr(parent, name)[place] = node


def compiled(text: str, name: str, space: dict) -> Callable | None:
    """The function of this text among the names of `space`; None if the change cannot be compiled."""
    made = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            exec(compile(text, f"a change of {name}", "exec"), space, made)
        except (SyntaxError, ValueError):
            return None
    return made[name]


class TimeUp(BaseException):
    """A change made a loop endless."""


def stopped(*_):
    raise TimeUp


def passes(exercise: Exercise, answer: Callable) -> bool:
    """Would the check accept it?"""
    rights = outcomes(exercise, exercise.solution)
    before = signal.signal(signal.SIGPROF, stopped)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for case, right in zip(exercise.all_arguments, rights, strict=True):
                given = copy.deepcopy(case)
                found = plain(exercise.outcome(answer, *given))
                if not same(fitted(found, right), right, exercise.tolerance):
                    return False
                if not all(
                    same(plain(after), plain(then), nan_too=True) for after, then in zip(given, case, strict=True)
                ):
                    return False
    except (Exception, TimeUp):
        return False
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
    return True


def left_out(exercise: Exercise) -> bool:
    return exercise.name in FREE or isinstance(exercise.solution, type)


def surviving(exercise: Exercise) -> tuple[int, list[str]]:
    """(how many changes were tried, those that the check accepts)."""
    if left_out(exercise):
        return 0, []
    tried = [(what, function) for what, function in mutants(exercise) if function is not None]
    return len(tried), [what for what, function in tried if passes(exercise, function)]


def main() -> None:
    """Of the exercises that are named, or of all."""
    for exercise in [e for e in registry().values() if not sys.argv[1:] or e.name in sys.argv[1:]]:
        tried, left = surviving(exercise)
        print(f"{exercise.name}: {tried} changes, {len(left)} pass", *left, sep="\n      ")


if __name__ == "__main__":
    main()
