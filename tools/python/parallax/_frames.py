"""Frames of pandas, where it is installed."""

from typing import Any, Dict, List, Optional, Sequence


def frame(rows: List[Dict[str, object]], columns: Sequence[str],
          index: Optional[Sequence[object]] = None, index_name: Optional[str] = None) -> Any:
    """Raises ImportError, with advice, where there is no pandas."""
    try:
        import pandas
    except ImportError:
        raise ImportError("frames need pandas: install python3-pandas, or use the dataclasses"
                          ) from None
    made = pandas.DataFrame(rows, columns=list(columns), index=index)
    if index_name is not None:
        made.index.name = index_name
    return made
