"""What Mitsuba 3 measures inside a closed furnace, near and far, tiny and huge.

    python mitsuba_furnace.py --json FILE [--variant scalar_rgb] [--spp 1024]

The scene is that of `cli/src/verify/truths/furnace_closed.scene` with `lights=true`: a closed shape that shines
inwards with radiance 1 and reflects half of what arrives, so that every place of it shows 1 / (1 - 1/2) = 2.
FILE gets the words that name the program, and by form, and by the shape's size and distance from the origin in
metres, the mean of the picture; or `null` where there is none. Needs mitsuba and numpy.
"""

import argparse
import json

import numpy as np

DEPTH, SIDE = 64, 8
# Distance from the origin and size, metres.
CELLS = [(away, 1) for away in (0, 1e3, 1e4, 1e5, 1e6, 1e7)]
CELLS += [(0, size) for size in (1e-9, 1e-6, 1e-4, 1e-3, 1e3, 1e6, 1e9)]


def scene(mi, form, away, size):
    off = np.array([away, -away, 0.5 * away])
    to_world = mi.ScalarTransform4f().translate(list(off)).scale(size)
    forms = {
        "sphere": {"type": "sphere", "center": list(off), "radius": size},
        "mesh": {"type": "cube", "to_world": to_world},
    }
    look = {"origin": list(off), "target": list(off + np.array([0.3, 0.2, -1]) * size), "up": [0, 1, 0]}
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": DEPTH + 1, "rr_depth": 3},
        "sensor": {
            "type": "perspective", "fov": 60, "to_world": mi.ScalarTransform4f().look_at(**look),
            "near_clip": 1e-3 * size, "far_clip": 1e4 * size,
            "film": {"type": "hdrfilm", "width": SIDE, "height": SIDE, "rfilter": {"type": "box"}},
        },
        "room": {
            **forms[form], "flip_normals": True,
            "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.5}},
            "light": {"type": "area", "radiance": {"type": "rgb", "value": 1.0}},
        },
    })


def mean(mi, args, form, away, size):
    try:
        return float(np.mean(np.array(mi.render(scene(mi, form, away, size), spp=args.spp), dtype=float)))
    except RuntimeError:
        return None


def main():
    import mitsuba as mi

    parser = argparse.ArgumentParser()
    parser.add_argument("--json", required=True)
    parser.add_argument("--variant", default="scalar_rgb")
    parser.add_argument("--spp", type=int, default=1024)
    args = parser.parse_args()
    mi.set_variant(args.variant)
    mi.set_log_level(mi.LogLevel.Error)
    found = {"program": f"Mitsuba {mi.__version__}, {args.variant}"}
    for form in ("sphere", "mesh"):
        found[form] = {f"{away:g} {size:g}": mean(mi, args, form, away, size) for away, size in CELLS}
    with open(args.json, "w") as file:
        json.dump(found, file)


if __name__ == "__main__":
    main()
