#!/usr/bin/env python3
"""Learns the network that `coapt segment` finds the free edge of ultrasound by, on phantoms of generated valves.

    bench/edge_network.py make FOLDER [--coapt PATH] [--layers PATH]    phantoms, unrolled: the files of `learn`
    bench/edge_network.py learn FOLDER [--steps N]                      writes src/image/edge/edge_weights.inc

`make` makes three families, of which the seeds of bench/image.py, 0 to 9, and rough valves 1 to 8 are left for figures. "drawn": generated
mitral valves, voxels of 0.5 mm without dropout and of 0.7 mm with 15 % dropout in turns, three in five with chords to the free edge and the
rough zone, the others with those of the generator or none. "rough": `--rough` valves, mitral and tricuspid in turns, voxels as before. "dense":
valves of all three kinds, scaled along their axes, most with up to 95 % of the vertices of the edge at chords of 0.1 to 2 mm2, in images of
many kinds. PATH of --layers is bench_edge_layers. `learn` needs PyTorch and takes ten minutes.

The network's logits, summed down a column, are the logarithms of the probabilities of an end at each place; it learns the least expected
distance from the true end, with a share of the cross-entropies of ends and places. It must not learn how long leaflets are: columns are
stretched, shortened and lengthened in their middle, and the distance from the annulus is withheld.
"""
import argparse
import json
import math
import pathlib
import random
import struct
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
WEIGHTS = ROOT / "src/image/edge/edge_weights.inc"
CASES = (["--voxel", "0.5mm", "--psf", "0.5mm", "0.5mm", "--dropout", "0"], ["--voxel", "0.7mm", "--psf", "0.8mm", "0.8mm", "--dropout", "0.15"])
CHORDS = ("both", "both", "generator", "both", "none")
FAMILIES = {"drawn": (range(101, 190), range(201, 209)), "rough": (range(101, 158), range(201, 209)),
            "dense": (range(101, 201), range(301, 313))}  # seeds to learn from, and to stop by
SHARES = {"drawn": 0.4, "rough": 0.25, "dense": 0.35}  # of the steps
STEPS, APART = 8000, 22  # the channel of the distance of columns
CHANNELS, HIDDEN, SPREADS = 24, 12, (1, 2, 4, 8)
STEP, SURE, TURNED = 0.5, 6, 6  # mm between places; places that are leaflet; after so many beyond the edge nothing is leaflet
WINDOW, PLACES = 80, 64  # columns and places of a step


def run(*arguments) -> None:
    subprocess.run(list(map(str, arguments)), check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def phantom(coapt: str, scene: pathlib.Path, seed: int, case: list[str], folder: pathlib.Path) -> pathlib.Path:
    extent = [] if "--thickness" in case else ["--shadows", 0, "--thickness", "1mm"]
    run(coapt, "phantom", scene, *case, *extent, "--seed", seed, "-o", folder / "phantom")
    return folder / "phantom/open"


def without_chords(source: pathlib.Path, valve: dict) -> pathlib.Path:
    for key in ("chords", "junctions", "membranes", "cables", "papillary_closed", "annulus_closed", "closed_reference"):
        valve.pop(key, None)
    bare = source.with_name("bare.json")
    bare.write_text(json.dumps(valve))
    return bare


def drawn(coapt: str, seed: int, folder: pathlib.Path) -> pathlib.Path:
    chords = CHORDS[(seed - 101) // 2 % 5]
    run(coapt, "generate", "mitral", "--seed", seed, "--triangles", 2500, "-o", folder / "drawn")
    source = folder / "drawn/valve.json"
    if chords != "generator":
        source = without_chords(source, json.loads(source.read_text()))
    if chords == "both":
        run(coapt, "chords", source, "--zones", "free_edge", "rough", "-o", folder / "valve/valve.json")
        source = folder / "valve/valve.json"
    run(coapt, "import", source, "-o", folder / "scene")
    return phantom(coapt, folder / "scene/scene.json", seed, CASES[(seed + 1) % 2], folder)


def rough(coapt: str, seed: int, folder: pathlib.Path) -> pathlib.Path:
    number = (seed - 101) % 100
    run(coapt, "generate", ("mitral", "tricuspid")[number % 2], "--rough", seed, "--triangles", 900, "-o", folder / "scene")
    return phantom(coapt, folder / "scene/scene.json", seed, CASES[number // 2 % 2], folder)


def dense(coapt: str, seed: int, folder: pathlib.Path) -> pathlib.Path:
    """A valve of any kind, scaled along three axes, most with many thick chords, in an image of any kind."""
    draw = random.Random(seed)
    kind = [["mitral", "--seed", seed], ["mitral", "--rough", seed], ["tricuspid", "--rough", seed]][seed % 3]
    run(coapt, "generate", *kind, "--triangles", draw.choice((1500, 2500, 4000)), "-o", folder / "drawn")
    source, scales = folder / "drawn/valve.json", [draw.uniform(0.8, 1.25) for _ in range(3)]
    valve = json.loads(source.read_text())
    scaled = lambda point: [x * scale for x, scale in zip(point, scales)]
    mesh = source.with_name(valve["leaflets"])
    lines = [line.split() for line in mesh.read_text().splitlines()]
    mesh.write_text("\n".join(" ".join(["v", *map(repr, scaled(map(float, line[1:4])))] if line[:1] == ["v"] else line) for line in lines) + "\n")
    for key in ("papillary", "junctions"):
        valve[key] = [scaled(point) for point in valve.get(key, [])]
    what = draw.random()
    if what < 0.2:  # its own chords
        for key in ("papillary_closed", "annulus_closed"):
            valve.pop(key, None)
        source.write_text(json.dumps(valve))
    else:
        source = without_chords(source, valve)
    if what > 0.32:  # else none
        branches, levels, zones = draw.randint(2, 5), draw.randint(1, 2), ["free_edge"] + ["rough"] * (draw.random() < 0.8)
        areas = [math.exp(draw.uniform(math.log(0.1), math.log(2))) for _ in range(levels)]
        ends = draw.uniform(0.35, 0.95) * len(valve["free_edge"])
        for fewer in (1, 0.7, 0.5, 0.3, 0.15):  # the zone may have fewer vertices
            count = max(4, int(fewer * ends / branches ** (levels - 1)))
            try:
                run(coapt, "chords", source, "--zones", *zones, "--count", count, "--levels", levels, "--branches", branches, "--level-areas",
                    *areas, "--seed", seed, "-o", folder / "valve/valve.json")
                source = folder / "valve/valve.json"
                break
            except subprocess.CalledProcessError:
                pass
    run(coapt, "import", source, "-o", folder / "scene")
    millimetres = lambda least, greatest: f"{draw.uniform(least, greatest):.2f}mm"
    case = ["--voxel", millimetres(0.5, 0.8), "--psf", millimetres(0.4, 0.8), millimetres(0.4, 1.0), "--dropout",
            f"{draw.choice((0, 0.1, 0.15, 0.25)):g}", "--shadows", draw.choice((0, 0, 2)), "--thickness", millimetres(0.7, 1.4),
            "--probe-distance", f"{draw.uniform(45, 90):.0f}mm"]
    return phantom(coapt, folder / "scene/scene.json", seed, case, folder)


def make(folder: pathlib.Path, coapt: str, layers: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for draw in (drawn, rough, dense):
        for seed in [seed for seeds in FAMILIES[draw.__name__] for seed in seeds]:
            output = folder / f"{draw.__name__}_{seed}.bin"
            if output.exists():
                continue
            with tempfile.TemporaryDirectory() as name:
                run(layers, draw(coapt, seed, pathlib.Path(name)), output)
            print(output, flush=True)


def read(path: pathlib.Path):
    """Channels x places x columns, the place of the true end of each column, and 1 for leaflet, -1 for none."""
    import numpy as np
    data = path.read_bytes()
    channels, places, columns = struct.unpack_from("<3i", data)
    numbers = np.frombuffer(data, np.float32, offset=12)
    count = channels * places * columns
    x = numbers[:count].reshape(places, columns, channels).transpose(2, 0, 1).copy()
    away, inside = numbers[count:].reshape(2, places, columns)
    side = np.where(away < 3, np.clip(inside, -1, 1), -1)
    side[:SURE] = 1
    side = np.where(x[-1] > 0, side, -1)
    beyond, gone = np.zeros(columns), np.zeros(columns, bool)
    for place in range(places):  # where the layer turns back it is no leaflet
        beyond = np.where(side[place] < 0, beyond + 1, 0)
        gone |= beyond >= TURNED
        side[place][gone] = -1
    ends = np.argmax(np.concatenate([np.zeros((1, columns)), np.cumsum(side, 0)]), 0)
    return x, ends, side.astype(np.float32)


def reshaped(x, ends, side, around, random):
    """Columns stretched, and shortened or lengthened in their middle; what is near the edge is seen as it was if they are not stretched."""
    import numpy as np
    places, columns = x.shape[1], x.shape[2]
    ring = lambda: sum(random.normal() * np.cos(2 * np.pi * k * np.arange(columns) / around + random.uniform(0, 2 * np.pi)) / (1 + k) ** 0.7
                       for k in range(6)) / 1.3
    source, kind = np.tile(np.arange(places, dtype=float)[:, None], (1, columns)), random.random()
    if kind < 0.7:
        stretch = random.uniform(np.log(0.6), np.log(1.5)) + (0.12 * ring() if random.random() < 0.5 else 0)
        source = source / np.clip(np.exp(stretch), 0.5, 1.7)
    if kind > 0.4:
        middle = np.maximum(ends - 2 * SURE, 0)
        start = SURE + random.uniform() * middle
        taken = np.minimum(random.uniform(-14, 14) + random.uniform(0, 5) * ring(), 0.8 * middle)  # places; put in where below 0
        long, put = random.uniform(1, 8), np.maximum(-taken, 0)
        longer = np.where(source < start, source,
                          np.where(source < start + long + put, start + (source - start) * long / (long + put), source - put))
        source = np.where(taken > 0, source + np.clip(source - start, 0, 1) * taken, np.where(taken < 0, longer, source))
    source = np.clip(source, 0, places - 1)
    beyond = (source >= places - 1) & (np.diff(source, axis=0, prepend=-1) <= 0)
    before, here = np.minimum(source.astype(int), places - 2), np.arange(columns)
    part, nearest = (source - before).astype(np.float32), np.rint(source).astype(int)
    changed = x[:, before, here] * (1 - part) + x[:, before + 1, here] * part
    changed[-1] = np.where(beyond, 0, x[-1][nearest, here])
    side = np.where(beyond, -1, side[nearest, here]).astype(np.float32)
    side[:SURE] = 1
    return changed, ((source + 0.5 < ends) & ~beyond).sum(0), side


def changed(x, ends, side, random):
    """Mirrored, turned, of another shape, brighter or darker, noisier, with more dropout."""
    import numpy as np
    if random.random() < 0.5:
        x, ends, side = x[:, :, ::-1], ends[::-1], side[:, ::-1]
    around, most = x.shape[2], min(x.shape[1], PLACES + 16)
    seen = (random.integers(around) + np.arange(WINDOW)) % around
    x, ends, side = x[:, :most, seen].copy(), np.minimum(ends[seen], most), side[:most, seen].copy()
    if random.random() < 0.8:
        x, ends, side = reshaped(x, ends, side, around, random)
    x[:21] = x[:21] * random.uniform(0.8, 1.25) + random.uniform(-0.12, 0.12)
    x[21] *= random.uniform(0.8, 1.25)
    x[APART] = x[APART] * np.exp(random.uniform(-0.3, 0.3)) + random.uniform(-0.1, 0.1)
    x[:21] += random.normal(0, random.uniform(0, 0.15), x[:21].shape)
    if random.random() < 0.4:
        rows, columns = np.mgrid[:most, :WINDOW]
        for _ in range(random.integers(1, 6)):
            apart = columns - random.integers(WINDOW)
            gap = ((rows - random.integers(most)) / random.uniform(2, 7)) ** 2 + (apart / random.uniform(2, 6)) ** 2 < 1
            x[4:13, gap] *= 0.2
            x[21, gap] *= 0.1
    x *= x[-1] > 0
    places = min(PLACES, most)
    return x[:, :places].astype(np.float32), np.minimum(ends, places), side[:places]


def learn(folder: pathlib.Path, steps: int, without: str) -> None:
    import numpy as np
    import torch
    from torch import nn
    from torch.nn import functional

    class Network(nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.first = nn.Conv2d(CHANNELS, HIDDEN, 1)
            self.middle = nn.ModuleList([nn.Conv2d(HIDDEN, HIDDEN, 3, dilation=spread) for spread in SPREADS])
            self.last = nn.Conv2d(HIDDEN, 1, 1)
            nn.init.zeros_(self.last.bias)

        def forward(self, x):
            x = functional.relu(self.first(x))
            for spread, layer in zip(SPREADS, self.middle):
                wide = functional.pad(functional.pad(x, (spread, spread, 0, 0), mode="circular"), (0, 0, spread, spread), mode="replicate")
                x = x + functional.relu(layer(wide))
            return 4 * torch.tanh(self.last(x)[:, 0] / 4)

    def losses(network, x, ends, side):
        x, ends, side = (torch.from_numpy(np.ascontiguousarray(a))[None] for a in (x, ends, side))
        logits, valid = network(x), x[:, -1] > 0
        scores = torch.where(valid, logits, torch.full_like(logits, -4))
        scores = torch.cat([torch.full_like(scores[:, :SURE], 4), scores[:, SURE:]], 1)
        likely = functional.log_softmax(torch.cat([torch.zeros_like(scores[:, :1]), torch.cumsum(scores, 1)], 1), 1)
        off = (torch.arange(likely.shape[1])[None, :, None] - ends[:, None]).abs() * STEP
        near = torch.exp(-0.5 * (off / 0.75) ** 2)
        expected = (likely.exp() * off).sum(1).mean()
        of_ends = -(near / near.sum(1, keepdim=True) * likely).sum(1).mean()
        counted = valid & (side.abs() > 0.99)
        of_places = functional.binary_cross_entropy_with_logits(logits[counted], (side[counted] > 0).float())
        return expected + 0.2 * of_ends + 0.5 * of_places, expected

    torch.manual_seed(0)
    torch.set_num_threads(1)
    random = np.random.default_rng(0)
    families = [name for name in FAMILIES if name != without]
    taught, stopping = ([[read(folder / f"{name}_{seed}.bin") for seed in FAMILIES[name][which]] for name in families] for which in (0, 1))
    shares = np.array([SHARES[name] for name in families])
    network, best, kept = Network(), float("inf"), {}
    descent = torch.optim.Adam(network.parameters(), weight_decay=1e-5)
    for step in range(steps):
        for group in descent.param_groups:
            group["lr"] = 0.002 * min(1, (step + 1) / 50) * (1 + np.cos(np.pi * step / steps)) + 1e-5
        group = taught[random.choice(len(taught), p=shares / shares.sum())]
        loss, _ = losses(network, *changed(*group[random.integers(len(group))], random))
        descent.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1)
        descent.step()
        if (step + 1) % max(1, steps // 8) == 0:
            with torch.no_grad():
                each = [np.mean([losses(network, *layer)[1].item() for layer in group]) for group in stopping]
            off = np.mean(each)
            print(f"step {step + 1}: {', '.join(f'{name} {mean:.3f}' for name, mean in zip(families, each))} mm down the columns", flush=True)
            if off < best:
                best, kept = off, {name: values.clone() for name, values in network.state_dict().items()}
    network.load_state_dict(kept)
    written(network)


def written(network) -> None:
    """Of each layer its taps, outputs fastest, then its offsets."""
    numbers: list[float] = []
    for layer in (network.first, *network.middle, network.last):
        numbers += layer.weight.detach().permute(2, 3, 1, 0).reshape(-1).tolist() + layer.bias.detach().tolist()
    words = [f"{number:#.4g}F" for number in numbers]
    lines = [", ".join(words[k:k + 13]) + "," for k in range(0, len(words), 13)]
    WEIGHTS.write_text("// Written by bench/edge_network.py: taps and offsets of each layer.\n" + "\n".join(lines) + "\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("make", "learn"))
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--coapt", default="build/ci/bin/coapt")
    parser.add_argument("--layers", default="build/separate/bench/bench_edge_layers")
    parser.add_argument("--steps", type=int, default=STEPS)
    parser.add_argument("--without", default="", choices=FAMILIES, help="a family that is not learnt from")
    options = parser.parse_args()
    if options.what == "make":
        make(options.folder, options.coapt, options.layers)
    else:
        learn(options.folder, options.steps, options.without)


if __name__ == "__main__":
    main()
