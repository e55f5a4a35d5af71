"""Writes chain_20.json: 20 links of 6 mm between anchors 100 mm apart, hung on a parabola to start with.

    make_chain.py > chain_20.json
"""
import json

LINKS, SPAN, LENGTH, AREA, START_SAG = 20, 100.0, 120.0, 10.0, 29.0


def point(step: int) -> list[float]:
    t = step / LINKS
    return [SPAN * t, 0.0, -4 * START_SAG * t * (1 - t)]


def end(step: int) -> dict:
    return {"papillary": step // LINKS} if step in (0, LINKS) else {"junction": step - 1}


chain = {
    "name": "chain of 20 links", "units": "mm", "index_base": 0,
    "papillary": [point(0), point(LINKS)],
    "junctions": [point(step) for step in range(1, LINKS)],
    "chords": [{"from": end(step), "to": end(step + 1), "rest_length": LENGTH / LINKS, "area": AREA}
               for step in range(LINKS)],
}
print(json.dumps(chain, indent=1))
