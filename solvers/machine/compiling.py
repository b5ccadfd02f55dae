"""How long this process has spent on compiling kernels, what shortens it, and whether it is to be as short as may be.

The time is that of tracing their Python, and of Taichi's compiler or its cache. With CARGOLAB_COMPILE=quick in the
environment, the kernels of discs take half the time to compile and run a fifth slower: neither on real vectors
(`machine.wide`) nor with their common subexpressions merged (`runtime.merge_repeats`). Numbers change in their last
digits. Those of water and of outlines take three quarters of the time; convex outlines run up to a seventh slower.
"""

import ast
import os
import time
from collections.abc import Callable
from functools import wraps

from solvers.machine.errors import Unavailable

_spent = 0.0


def quick() -> bool:
    """Whether kernels are to compile fast rather than run fast. Raises Unavailable, one sentence, if it is unclear."""
    wanted = os.environ.get("CARGOLAB_COMPILE", "")
    if wanted not in ("", "quick"):
        raise Unavailable(f"CARGOLAB_COMPILE is {wanted!r}: set it to quick, or not at all.")
    return bool(wanted)


def seconds() -> float:
    """Seconds spent so far."""
    return _spent


def watch() -> None:
    """Have Taichi's two steps of compiling a kernel be timed from now on; needs Taichi to be imported."""
    from taichi._lib.core.taichi_python import Program
    from taichi.lang.kernel_impl import Kernel

    for kind, step in ((Kernel, "materialize"), (Program, "compile_kernel")):
        if not hasattr(getattr(kind, step), "__wrapped__"):
            setattr(kind, step, _timed(getattr(kind, step)))


def compute_once() -> None:
    """Have a number that is combined with a vector be computed once from now on; needs Taichi to be imported.

    Taichi 1.7.4 writes it out for each component: `volume[j] * lanes` reads the array 16 times, until LLVM finds that
    all are the same. That was half of the statements of a kernel of water, and its compiler walks through all of them
    for each one that it replaces. Such a kernel now compiles in three fifths of the time. A step costs the same
    within the scatter of its timings, 5 % and, with air, 15 %.
    """
    from taichi.lang import ops

    if not hasattr(ops._binary_operation, "__wrapped__"):
        ops._binary_operation = _with_numbers_kept(ops._binary_operation)


def _with_numbers_kept(operation: Callable) -> Callable:
    from taichi.lang.expr import Expr
    from taichi.lang.impl import expr_init

    @wraps(operation)
    def kept(compiled: Callable, interpreted: Callable, a, b):
        if isinstance(a, Expr) and isinstance(b, Expr) and a.ptr.is_tensor() != b.ptr.is_tensor():
            a, b = (one if one.ptr.is_tensor() or _is_variable(one) else expr_init(one) for one in (a, b))
        return operation(compiled, interpreted, a, b)

    return kept


def copy_once() -> None:
    """Have a value be copied as often as it must from now on; needs Taichi to be imported.

    Taichi 1.7.4 copies what is assigned twice, and every argument, also if the function never changes it. For each copy
    it walks through the whole kernel, and so it does for each number that is cast. Of the 7600 statements of a kernel
    of water 3600 were such copies, and 3000 of its numbers were cast. LLVM found that all of them are the same: the
    bits of a run do not change. Without them Taichi's compiler takes five sixths of the time for this kernel, and a
    little less than before for discs.
    """
    import taichi as ti
    from taichi.lang import impl, ops
    from taichi.lang.ast.ast_transformer import ASTTransformer

    if not hasattr(ops.cast, "__wrapped__"):
        ops.cast = ti.cast = _of_known_numbers(ops.cast)
        ASTTransformer.build_Assign = staticmethod(_assign)
        ASTTransformer.build_FunctionDef = staticmethod(_noting_what_lasts(ASTTransformer.build_FunctionDef))
        impl.expr_init_func = _copied_unless_it_lasts(impl.expr_init_func)


def _is_variable(value: object) -> bool:
    """Whether a value is that of a local variable of a kernel."""
    from taichi.lang.expr import Expr

    if type(value) is not Expr or not value.ptr.is_lvalue():
        return False
    return not (value.ptr.is_index_expr() or value.ptr.is_external_tensor_expr())


def _of_known_numbers(cast: Callable) -> Callable:
    """A number that has the same value in 32 bits needs no cast."""
    import numpy as np
    import taichi as ti
    from taichi.lang.expr import Expr

    @wraps(cast)
    def known(value, kind):
        if type(value) in (int, float) and kind in (ti.f32, ti.f64) and float(np.float32(value)) == value:
            return Expr(float(value), dtype=kind)
        return cast(value, kind)

    return known


def _assign(context, node: ast.Assign) -> None:
    """`build_Assign` of Taichi's, with one copy of each value."""
    from taichi.lang import impl
    from taichi.lang.ast.ast_transformer import ASTTransformer, build_stmt

    build_stmt(context, node.value)
    value, (target, *more) = node.value.ptr, node.targets
    fixed = isinstance(node.value, ast.Call) and node.value.func.ptr is impl.static
    called = any(isinstance(part, ast.Call) for part in ast.walk(target))  # which might change what the value is
    if not (fixed or more or called or isinstance(target, ast.Tuple)):
        ASTTransformer.build_assign_basic(context, target, value, False)
        return
    value = value if fixed else impl.expr_init(value)
    if more or fixed or not (isinstance(target, ast.Tuple) and isinstance(value, tuple | list)):
        for one in node.targets:
            ASTTransformer.build_assign_unpack(context, one, value, fixed)
        return
    if len(target.elts) != len(value):
        raise ValueError(f"{len(value)} values for {len(target.elts)} names")
    for one, own in zip(target.elts, value, strict=True):
        if isinstance(one, ast.Name) and one.id not in context.kernel_args and not context.is_var_declared(one.id):
            context.create_variable(one.id, own)
        else:
            ASTTransformer.build_assign_basic(context, one, own, False)


_lasting: set[int] = set()  # arguments of the function that is being entered, by `id`, that it may use as they are


def _noting_what_lasts(build: Callable) -> Callable:
    @wraps(build)
    def noting(context, node: ast.FunctionDef):
        _lasting.clear()
        if not context.is_kernel and not context.is_real_function:
            given, changed = context.argument_data, _changed(context.func.func, node)
            every = [id(part) for value in given for part in (value if isinstance(value, list | tuple) else [value])]
            for name, value in zip(node.args.args, given, strict=True):
                if name.arg not in changed and every.count(id(value)) == 1 and _is_variable(value):
                    _lasting.add(id(value))
        return build(context, node)

    return noting


def _copied_unless_it_lasts(copied: Callable) -> Callable:
    @wraps(copied)
    def unless(value):
        return value if id(value) in _lasting else copied(value)

    return unless


_names: dict[Callable, frozenset[str]] = {}


def _changed(function: Callable, node: ast.FunctionDef) -> frozenset[str]:
    """Names in a function that it changes, or that another one which it calls may change."""
    if function not in _names:
        found: set[str] = set()
        for part in ast.walk(node):
            if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store | ast.Del):
                found.add(part.id)
            elif isinstance(part, ast.Subscript | ast.Attribute) and isinstance(part.ctx, ast.Store):
                found |= _names_in(part.value)
            elif isinstance(part, ast.Call) and not _only_computes(part.func):
                found |= _names_in(part)
        _names[function] = frozenset(found)
    return _names[function]


def _names_in(part: ast.AST) -> set[str]:
    return {one.id for one in ast.walk(part) if isinstance(one, ast.Name)}


def _only_computes(called: ast.AST) -> bool:
    """Whether what is called is a function of Taichi's that gives a value and changes nothing."""
    of_taichi = isinstance(called, ast.Attribute) and isinstance(called.value, ast.Name) and called.value.id == "ti"
    return of_taichi and not called.attr.startswith("atomic")


def _timed(step: Callable) -> Callable:
    @wraps(step)
    def timed(*args, **kwargs):
        global _spent
        begun = time.perf_counter()
        try:
            return step(*args, **kwargs)
        finally:
            _spent += time.perf_counter() - begun

    return timed
