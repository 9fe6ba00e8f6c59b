"""Luxel beside Mitsuba 3, on the same scenes: do the pictures agree, and at what speed.

    python compare.py accuracy --luxel target/release/luxel [--spp 1024] [--res 256]
    python compare.py speed    --luxel target/release/luxel [--spp 16] [--res 512] [--rounds 5]

Each program ends paths by chance as it does unless it is told otherwise.

`accuracy` prints the ratio of means, with its standard error, for the whole picture and for the
pixels that lie whole on one surface, and for the grey box the relative MSE of 32 x 32 blocks at
growing sample counts. `speed` interleaves the programs and counts processor time (user + system):
Luxel's is that of the whole process, with reading the scene and writing the picture; Mitsuba's that
of the render call alone, after a first one that compiles its kernels. `luxel_alone` is Luxel without
reading and writing, as Mitsuba is measured: the time that its samples took by the clock on all cores,
which is no less than the processor time that they took. relMSE is the mean of
(I - R)^2 / (R^2 + 0.01) less the reference's own variance, and efficiency 1 / (relMSE * seconds),
with seconds of processor time over the number of cores. The last column is Luxel's time over the
other's, round by round: median, least and greatest. `--json FILE` writes the same figures for
programs, by scene. Needs mitsuba and numpy; for the llvm variants on AVX-512, LLVM 19 or later
(DRJIT_LIBLLVM_PATH).
"""

import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

import numpy as np

import mitsuba_cornell as scenes

HERE = pathlib.Path(__file__).parent
CORES = len(os.sched_getaffinity(0))
XYZ_OF_RGB = np.array(
    [[0.4123907993, 0.3575843394, 0.1804807884], [0.2126390059, 0.7151686788, 0.0721923154],
     [0.0193308187, 0.1191947798, 0.9505321522]]
)


def cpu(who):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def ply(args):
    """The mesh of `waves`."""
    return scenes.waves_ply(pathlib.Path(args.keep) / "waves.ply")


def scene_file(args, scene):
    """A scene of Luxel; beside its mesh if it has one."""
    path = HERE / "scenes" / f"{scene}.scene"
    if scene != "waves":
        return path
    beside = ply(args).with_suffix(".scene")
    beside.write_text(path.read_text())
    return beside


def luxel(args, scene, res, spp, seed):
    """Picture, the processor time of the whole process, and at most that of the samples alone."""
    import mitsuba as mi

    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        before = cpu(resource.RUSAGE_CHILDREN)
        command = [args.luxel, "render", str(scene_file(args, scene)), "--json", "-o", str(out)]
        command += ["--size", f"{res}x{res}", "--spp", str(spp), "--seed", str(seed)]
        ran = subprocess.run(command, check=True, capture_output=True)
        seconds = cpu(resource.RUSAGE_CHILDREN) - before
        alone = min(seconds, json.loads(ran.stdout)["seconds"] * CORES)
        bitmap = mi.Bitmap(str(out) + ".exr")
        names = [field.name for field in bitmap.struct_()]
        pixels = np.array(bitmap, dtype=float)
        return pixels[..., [names.index(c) for c in "RGB"]], seconds, alone


def mitsuba(scene, spp, seed):
    """Picture, and the processor time of the render call."""
    import mitsuba as mi

    before = cpu(resource.RUSAGE_SELF)
    picture = np.array(mi.render(scene, spp=spp, seed=seed), dtype=float)
    return picture, cpu(resource.RUSAGE_SELF) - before


def variant_for(scene):
    return "llvm_ad_spectral" if scene == "cornell_spectral" else "llvm_ad_rgb"


def reference(args, scene, res):
    """Independent pictures of a scene by Mitsuba, kept between runs in `args.keep`."""
    import mitsuba as mi

    path = pathlib.Path(args.keep) / f"{scene}_{res}_{args.reference_spp}.npy"
    if path.exists():
        return np.load(path)
    mi.set_variant(variant_for(scene))
    ready, chunk = scenes.load(mi, scene, res, 64, ply(args)), 64
    groups = [[] for _ in range(16)]
    for i in range(max(args.reference_spp // chunk, 16)):
        groups[i % 16].append(mitsuba(ready, chunk, 1_000 + i)[0])
    stack = np.stack([np.mean(group, 0) for group in groups]).astype(np.float32)
    path.parent.mkdir(parents=True, exist_ok=True)
    np.save(path, stack)
    return stack


def accuracy(args):
    """By scene: [difference, standard error] of each channel by region; `blocks` of the grey box."""
    import mitsuba as mi

    found = {}
    mi.set_variant("scalar_rgb")
    for scene in args.scenes:
        stack = reference(args, scene, args.res).astype(float)
        mi.set_variant("scalar_rgb")
        # Seeds, not error bars of pixels: those of Sobol samples are an upper estimate.
        runs = [luxel(args, scene, args.res, args.spp, 10 + i)[0] for i in range(args.seeds)]
        if scene == "cornell_spectral":
            runs = [run @ XYZ_OF_RGB.T for run in runs]
        factor = scenes.LUXEL_PER_MITSUBA.get(scene, 1.0)
        print(f"\n{scene}: {args.res}^2, Luxel {args.spp} spp x {args.seeds} seeds, channel ratios Luxel / ({factor:.6g} x Mitsuba)")
        regions = {}
        for name, mask in scenes.regions(scene, args.res).items():
            if not mask.any():
                continue
            ours = np.array([run[mask].mean(0) for run in runs])
            theirs = np.array([group[mask].mean(0) for group in stack]) * factor
            ratio = ours.mean(0) / theirs.mean(0)
            noise = lambda x: x.std(0, ddof=1) / len(x) ** 0.5 / x.mean(0)
            error = np.hypot(noise(ours), noise(theirs))
            regions[name] = list(zip(ratio - 1, error))
            cells = "  ".join(f"{r:+.5f} +- {e:.5f}" for r, e in regions[name])
            print(f"  {name:8} {mask.sum():6} px  {cells}")
        found[scene] = {"regions": regions}
        if scene == "cornell_grey":
            found[scene]["blocks"] = blocks(args, stack)
    return found


def blocks(args, stack):
    """Relative MSE over 32 x 32 blocks, which falls as 1/N until a difference shows; Mitsuba's own."""
    half = lambda x: x.reshape(args.res // 32, 32, args.res // 32, 32, 3).mean((1, 3))
    theirs = np.array([half(group) for group in stack])
    mean = theirs.mean(0)
    own = (theirs.var(0, ddof=1) / len(theirs) / mean**2).mean()
    print(f"  relMSE of 32 x 32 blocks (Mitsuba's own noise: {own:.2e})")
    of_spp = []
    for spp in (4, 16, 64, 256):
        found = [((half(luxel(args, "cornell_grey", args.res, spp, 90 + i)[0]) / mean - 1) ** 2).mean() for i in range(3)]
        of_spp.append((spp, statistics.mean(found)))
        print(f"    {spp:5} spp  {of_spp[-1][1]:.3e}")
    return {"own": own, "of_spp": of_spp}


def relative_mse(picture, stack):
    mean = stack.mean(0)
    weight = 1 / (mean**2 + 0.01)
    noise = stack.var(0, ddof=1) / len(stack)
    return float((((picture - mean) ** 2 - noise) * weight).mean())


def speed(args):
    """By scene and program: medians, rate and efficiency, and Luxel's time over the program's."""
    import mitsuba as mi

    tables = {}
    for scene in args.scenes:
        if scene in ("cornell_grey", "cornell_spectral"):
            continue
        stack = reference(args, scene, args.res).astype(float)
        ready = {}
        for variant in args.variants:
            mi.set_variant(variant)
            ready[variant] = scenes.load(mi, scene, args.res, args.spp, ply(args))
            if variant.startswith("llvm"):
                mitsuba(ready[variant], args.spp, 1)
        rows = {name: [] for name in ["luxel", "luxel_alone", *args.variants]}
        for i in range(args.rounds):
            picture, seconds, alone = luxel(args, scene, args.res, args.spp, 500 + i)
            error = relative_mse(picture, stack)
            rows["luxel"].append((seconds, error))
            rows["luxel_alone"].append((alone, error))
            for variant in args.variants:
                mi.set_variant(variant)
                picture, seconds = mitsuba(ready[variant], args.spp, 500 + i)
                rows[variant].append((seconds, relative_mse(picture, stack)))
        tables[scene] = table = {name: figures(args, rows, found) for name, found in rows.items()}
        print(f"\n{scene}: {args.res}^2, {args.spp} spp, {args.rounds} rounds interleaved, {CORES} cores")
        print(f"  {'':14}{'cpu s':>8}{'spread':>9}{'Mpaths/cpu-s':>14}{'relMSE':>11}{'spread':>9}{'efficiency':>12}{'Luxel is':>10}{'its time, of each round':>26}")
        for name, it in table.items():
            cells = f"{it['seconds']:8.2f}{it['spread']:9.1%}{it['rate']:14.3f}{it['relmse']:11.5f}{it['relmse_spread']:9.1%}{it['efficiency']:12.2f}"
            least, middle, most = it["of_time"]
            paired = f"{middle:12.3f} ({least:.3f}..{most:.3f})"
            print(f"  {name:14}{cells}{table['luxel']['efficiency'] / it['efficiency']:9.2f}x{paired}")
    return tables


def figures(args, rows, found):
    """Of the seconds and relMSE of a program's rounds, beside those of Luxel's, whole and alone."""
    times, errors = zip(*found)
    seconds, relmse = statistics.median(times), statistics.median(errors)
    spread = lambda x: (max(x) - min(x)) / statistics.median(x)
    of_time = lambda name: [luxel[0] / theirs for luxel, theirs in zip(rows[name], times)]
    ends = lambda x: [min(x), statistics.median(x), max(x)]
    return {
        "seconds": seconds,
        "spread": spread(times),
        "rate": args.res**2 * args.spp / seconds / 1e6,
        "relmse": relmse,
        "relmse_spread": spread(errors),
        "efficiency": 1 / (relmse * seconds / CORES),
        "of_time": ends(of_time("luxel")),
        "of_time_alone": ends(of_time("luxel_alone")),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("accuracy", "speed"))
    parser.add_argument("--luxel", required=True)
    parser.add_argument("--spp", type=int)
    parser.add_argument("--res", type=int)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--reference-spp", type=int, default=2048)
    parser.add_argument("--scenes", nargs="+", default=list(scenes.SCENES), choices=scenes.SCENES)
    parser.add_argument("--variants", nargs="+", default=["scalar_rgb", "llvm_ad_rgb"])
    parser.add_argument("--keep", default=str(pathlib.Path(tempfile.gettempdir()) / "luxel-bench"))
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    args.spp = args.spp or (256 if args.what == "accuracy" else 16)
    args.res = args.res or (256 if args.what == "accuracy" else 512)
    sys.stdout.reconfigure(line_buffering=True)
    found = (accuracy if args.what == "accuracy" else speed)(args)
    if args.json:
        args.json.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
