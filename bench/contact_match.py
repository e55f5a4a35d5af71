"""How well the vertices that a solve of the published tricuspid valve finds in contact are those that its data names."""
import json
import pathlib
import re
import struct

DISTANCE = 0.3  # mm; that of the figures of the published surface in docs/metrics.md
CODES = {"Float64": "d", "Int32": "i"}


def point_numbers(vtp: pathlib.Path, name: str) -> tuple[float, ...]:
    """An array on the points of a file that `coapt solve` wrote: raw bytes, their count before them as UInt64."""
    header, _, appended = vtp.read_bytes().partition(b'<AppendedData encoding="raw">\n_')
    points = header.partition(b"<PointData>")[2].partition(b"</PointData>")[0].decode()
    kind, offset = re.search(f'type="(.*)" Name="{name}" .*offset="([0-9]+)"', points).groups()
    (size,) = struct.unpack_from("<Q", appended, int(offset))
    count = size // struct.calcsize(CODES[kind])
    return struct.unpack_from(f"<{count}{CODES[kind]}", appended, int(offset) + 8)


def named_vertices(data: pathlib.Path, is_full: bool) -> set[int]:
    """The coarse mesh names none: its vertices are some of the full one's, in contact where these are."""
    named = set(json.loads((data / "valve.json").read_text())["reference_contact_vertices"])
    if is_full:
        return named
    originals = json.loads((data / "valve_coarse.json").read_text())["original_vertex"]
    return {vertex for vertex, original in enumerate(originals) if original in named}


def precision_and_recall(vtp: pathlib.Path, data: pathlib.Path, is_full: bool) -> tuple[float, float]:
    """Of the vertices within DISTANCE, or the contact term's range if that is more, of a facet that is no neighbour,
    the share that the data names; and the share of the named ones that are found."""
    gaps, flags = point_numbers(vtp, "gap"), point_numbers(vtp, "contact")  # a gap of -1: none near
    found = {vertex for vertex, gap in enumerate(gaps) if flags[vertex] or 0 <= gap <= DISTANCE}
    named = named_vertices(data, is_full)
    common = len(found & named)
    return common / max(1, len(found)), common / max(1, len(named))
