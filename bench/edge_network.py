#!/usr/bin/env python3
"""Learns the network that `coapt segment` finds the free edge of ultrasound by, on phantoms of generated valves.

    bench/edge_network.py make FOLDER [--coapt PATH] [--layers PATH]    phantoms, unrolled: the files of `learn`
    bench/edge_network.py learn FOLDER [--steps N]                      writes src/image/edge/edge_weights.inc

`make` draws mitral valves of seeds 100 to 189 to learn from, and 200 to 211 to stop by; those of bench/image.py, 0 to 9, are left for its
figures. Voxels of 0.5 mm without dropout and of 0.7 mm with 15 % dropout in turns; three in five with chords to the free edge and the rough
zone, the others with those of the generator or none. PATH of --layers is bench_edge_layers. `learn` needs PyTorch and takes ten minutes.

The network's logits, summed down a column, are the logarithms of the probabilities of an end at each place; it learns the least expected
distance from the true end, with a share of the cross-entropies of ends and places.
"""
import argparse
import json
import pathlib
import struct
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
WEIGHTS = ROOT / "src/image/edge/edge_weights.inc"
CASES = (["--voxel", "0.5mm", "--psf", "0.5mm", "0.5mm", "--dropout", "0"], ["--voxel", "0.7mm", "--psf", "0.8mm", "0.8mm", "--dropout", "0.15"])
CHORDS = ("both", "both", "generator", "both", "none")
STOPPING = range(200, 212)
CHANNELS, HIDDEN, SPREADS = 25, 12, (1, 2, 4, 4)
STEP, SURE, TURNED = 0.5, 6, 6  # mm between places; places that are leaflet; after so many beyond the edge nothing is leaflet
WINDOW, PLACES = 80, 64  # columns and places of a step


def made(coapt: str, layers: str, seed: int, case: list[str], chords: str, output: pathlib.Path) -> None:
    run = lambda *arguments: subprocess.run(list(map(str, arguments)), check=True, stdout=subprocess.DEVNULL)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run(coapt, "generate", "mitral", "--seed", seed, "--triangles", 2500, "-o", folder / "drawn")
        source = folder / "drawn/valve.json"
        if chords != "generator":
            valve = json.loads(source.read_text())
            for key in ("chords", "junctions", "membranes", "papillary_closed"):
                valve.pop(key, None)
            (folder / "bare.json").write_text(json.dumps(valve))
            source = folder / "bare.json"
        if chords == "both":
            run(coapt, "chords", source, "--zones", "free_edge", "rough", "-o", folder / "valve/valve.json")
            source = folder / "valve/valve.json"
        run(coapt, "import", source, "-o", folder / "scene")
        run(coapt, "phantom", folder / "scene/scene.json", *case, "--shadows", 0, "--thickness", "1mm", "--seed", seed, "-o", folder / "phantom")
        run(layers, folder / "phantom/open", output)


def make(folder: pathlib.Path, coapt: str, layers: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate([*range(100, 190), *STOPPING]):
        output = folder / f"{seed}.bin"
        if not output.exists():
            made(coapt, layers, seed, CASES[number % 2], CHORDS[number // 2 % 5], output)
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


def changed(x, ends, side, random):
    """Mirrored, turned, brighter or darker, noisier, with more dropout."""
    import numpy as np
    if random.random() < 0.5:
        x, ends, side = x[:, :, ::-1], ends[::-1], side[:, ::-1]
    turn = random.integers(x.shape[2])
    x, ends, side = np.roll(x, turn, 2), np.roll(ends, turn), np.roll(side, turn, 1)
    x[:21] = x[:21] * random.uniform(0.85, 1.15) + random.uniform(-0.1, 0.1)
    x[21] *= random.uniform(0.85, 1.15)
    x[:21] += random.normal(0, random.uniform(0, 0.12), x[:21].shape)
    if random.random() < 0.4:
        rows, columns = np.mgrid[:x.shape[1], :x.shape[2]]
        for _ in range(random.integers(1, 8)):
            apart = (columns - random.integers(x.shape[2]) + x.shape[2] // 2) % x.shape[2] - x.shape[2] // 2
            gap = ((rows - random.integers(x.shape[1])) / random.uniform(2, 7)) ** 2 + (apart / random.uniform(2, 6)) ** 2 < 1
            x[4:13, gap] *= 0.2
            x[21, gap] *= 0.1
    x *= x[-1] > 0
    return x[:, :PLACES, :WINDOW].copy(), np.minimum(ends[:WINDOW], min(PLACES, x.shape[1])), side[:PLACES, :WINDOW].copy()


def learn(folder: pathlib.Path, steps: int) -> None:
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
    files = sorted(folder.glob("*.bin"))
    taught = [read(path) for path in files if int(path.stem) not in STOPPING]
    stopping = [read(path) for path in files if int(path.stem) in STOPPING]
    network, best, kept = Network(), float("inf"), {}
    descent = torch.optim.Adam(network.parameters(), weight_decay=1e-5)
    for step in range(steps):
        for group in descent.param_groups:
            group["lr"] = 0.002 * min(1, (step + 1) / 50) * (1 + np.cos(np.pi * step / steps)) + 1e-5
        loss, _ = losses(network, *changed(*taught[random.integers(len(taught))], random))
        descent.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1)
        descent.step()
        if (step + 1) % max(1, steps // 16) == 0:
            with torch.no_grad():
                off = np.mean([losses(network, *layer)[1].item() for layer in stopping])
            print(f"step {step + 1}: {off:.3f} mm down the columns, on valves to stop by", flush=True)
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
    parser.add_argument("--steps", type=int, default=8000)
    options = parser.parse_args()
    if options.what == "make":
        make(options.folder, options.coapt, options.layers)
    else:
        learn(options.folder, options.steps)


if __name__ == "__main__":
    main()
