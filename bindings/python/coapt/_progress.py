"""A progress bar for notebooks and terminals, by tqdm where it is installed."""
from __future__ import annotations

import contextlib
import importlib
from collections.abc import Callable, Iterator
from typing import Any

from . import _core

Callback = Callable[[_core.Iterate], Any]


@contextlib.contextmanager
def shown(callback: Callback | None, is_wanted: bool) -> Iterator[Callback | None]:
    """The callback with a bar beside it; the callback itself where none is wanted or there is no tqdm."""
    bar = _bar() if is_wanted else None
    if bar is None:
        yield callback
        return

    def see(at: _core.Iterate) -> Any:
        bar.update(1)
        bar.set_postfix_str(f"residual {at.residual:.1e}", refresh=False)
        return None if callback is None else callback(at)

    try:
        yield see
    finally:
        bar.close()


def _bar() -> Any:
    try:
        tqdm = importlib.import_module("tqdm.auto").tqdm
    except ImportError:
        return None
    return tqdm(desc="coapt", unit=" iterates", mininterval=0.2)
