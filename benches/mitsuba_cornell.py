"""The bench scenes for Mitsuba 3 (pip install mitsuba), and reference pictures of them.

    python mitsuba_cornell.py SCENE --variant llvm_ad_rgb --res 256 --spp 64 --batches 64 --out ref.npy

writes an array of shape (batches, height, width, 3): independent pictures in linear sRGB (XYZ for
spectral variants), whose spread is the error of their mean. The scenes equal `scenes/*.scene`.

Where the two programs' pixels differ by convention (all derived, none fitted):
- rgb scenes: a pixel is radiance per channel in both. Factor 1.
- spectral scenes: Mitsuba's Y is the sum of L·ybar over 106.7502..., Luxel's the sum of L·470 nm·ybar
  over the integral of ybar, 106.857 nm. The scene files ask for the same L; `LUXEL_PER_MITSUBA` is
  the quotient.
"""

import argparse
import csv
import pathlib

import numpy as np

HERE = pathlib.Path(__file__).parent

# Vertices of the Cornell box in mm (Cornell Program of Computer Graphics): (name, material, corners).
LAMP_Y = 548.3  # 0.5 mm below the ceiling, more than any ray offset
QUADS = [
    ("lamp", "lamp", [(343, LAMP_Y, 227), (343, LAMP_Y, 332), (213, LAMP_Y, 332), (213, LAMP_Y, 227)]),
    ("floor", "white", [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]),
    ("ceiling", "white", [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]),
    ("back", "white", [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]),
    ("right", "green", [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]),
    ("left", "red", [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]),
]
BLOCKS = [
    ("short", 165, [(130, 65), (82, 225), (240, 272), (290, 114)]),
    ("tall", 330, [(423, 247), (265, 296), (314, 456), (472, 406)]),
]
RGB = {"white": (0.725, 0.71, 0.68), "red": (0.63, 0.065, 0.05), "green": (0.14, 0.45, 0.091)}
LAMP_RGB = (17.0, 12.0, 4.0)
LAMP_REFLECTANCE = 0.78
LAMP_CURVE = [(400, 0.0), (500, 8.0), (600, 15.6), (700, 18.4)]
GLASS = {"center": (170, 100, 180), "radius": 100}
METAL = {"center": (385, 110, 370), "radius": 110}
METAL_ETA, METAL_K = (0.2, 0.92, 1.1), (3.9, 2.45, 2.14)
SCENES = ("cornell_rgb", "cornell_grey", "cornell_spectral", "glass_metal", "waves")
WAVES_SIDE = 1024  # vertices along each side of the wavy square

Y_INTEGRAL = 106.85691491676702  # of ybar over 360..830 nm, nm, CIE 1931 at 1 nm
LUXEL_PER_MITSUBA = {
    "cornell_spectral": 470.0 * 106.7502593994140625 / Y_INTEGRAL,
}


def quads(scene):
    """All flat faces of a scene: (region, material, corners)."""
    faces = list(QUADS)
    if scene == "glass_metal":
        return faces
    for name, height, base in BLOCKS:
        low = [(x, 0, z) for x, z in base]
        high = [(x, height, z) for x, z in base]
        faces.append((name, "white", high))
        for i in range(4):
            j = (i + 1) % 4
            faces.append((name, "white", [low[i], low[j], high[j], high[i]]))
    return faces


def reflectances(path=HERE / "scenes" / "cornell_reflectance.csv"):
    """Measured spectra: wavelengths, and values by material."""
    rows = list(csv.DictReader(line for line in open(path) if not line.startswith("#")))
    nm = [float(row["wavelength"]) for row in rows]
    return nm, {name: [float(row[name]) for row in rows] for name in ("white", "green", "red")}


def irregular(points):
    nm, values = zip(*points)
    join = lambda xs: ", ".join(repr(float(x)) for x in xs)
    return {"type": "irregular", "wavelengths": join(nm), "values": join(values)}


def colours(scene):
    """Reflectance by material, and the lamp's radiance, as Mitsuba dictionaries."""
    rgb = lambda c: {"type": "rgb", "value": list(c)}
    if scene == "cornell_grey":
        grey = rgb((0.5, 0.5, 0.5))
        return dict.fromkeys(("white", "red", "green", "lamp"), grey), rgb((1.0, 1.0, 1.0))
    if scene == "cornell_spectral":
        nm, values = reflectances()
        found = {name: irregular(zip(nm, v)) for name, v in values.items()}
        found["lamp"] = irregular([(360, LAMP_REFLECTANCE), (830, LAMP_REFLECTANCE)])
        return found, irregular(LAMP_CURVE)
    found = {name: rgb(c) for name, c in RGB.items()}
    found["lamp"] = rgb((LAMP_REFLECTANCE,) * 3)
    return found, rgb(LAMP_RGB)


def quad_mesh(mi, name, corners, bsdf, emitter=None):
    props = mi.Properties()
    props["bsdf"] = bsdf
    if emitter is not None:
        props["emitter"] = emitter
    mesh = mi.Mesh(name, 4, 2, props=props)
    params = mi.traverse(mesh)
    params["vertex_positions"] = np.asarray(corners, np.float32).ravel()
    params["faces"] = np.asarray([0, 1, 2, 0, 2, 3], np.uint32)
    params.update()
    return mesh


def waves_ply(path):
    """Writes the wavy square of `scenes/waves.scene`: whatever of this name was there may be another one."""
    at = 2 * np.arange(WAVES_SIDE, dtype=np.float32) / np.float32(WAVES_SIDE - 1) - 1
    z, x = np.meshgrid(at, at, indexing="ij")
    y = 0.05 * np.sin(23 * x) * np.cos(17 * z)
    points = np.stack([x, y, z], -1).astype("<f4")
    corner = np.arange(WAVES_SIDE**2, dtype=np.int32).reshape(WAVES_SIDE, WAVES_SIDE)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]
    faces = np.stack([a, c, d, a, d, b], -1).reshape(-1, 3)
    rows = np.zeros(len(faces), dtype=[("n", "u1"), ("i", "<i4", 3)])
    rows["n"], rows["i"] = 3, faces
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {WAVES_SIDE**2}\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header.encode() + points.tobytes() + rows.tobytes())
    return path


def waves(mi, res, spp, ply):
    """The wavy square under an even sky."""
    look = mi.ScalarTransform4f().look_at(origin=[0, 2, 3], target=[0, 0, 0], up=[0, 1, 0])
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": -1, "rr_depth": 5},
        "sensor": {
            "type": "perspective", "fov": 40.0, "fov_axis": "y", "to_world": look,
            "film": {
                "type": "hdrfilm", "width": res, "height": res, "rfilter": {"type": "box"},
                "pixel_format": "rgb", "component_format": "float32",
            },
            "sampler": {"type": "independent", "sample_count": spp},
        },
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [1.0, 1.0, 1.0]}},
        "mesh": {
            "type": "ply", "filename": str(ply), "face_normals": True,
            "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.5] * 3}}},
        },
    })


def load(mi, scene, res, spp, ply=None):
    """The scene in the variant that is set, ready for `mi.render`."""
    if scene == "waves":
        return waves(mi, res, spp, ply)
    reflectance, lamp = colours(scene)
    bsdf = {
        name: mi.load_dict({"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": value}})
        for name, value in reflectance.items()
    }
    look = mi.ScalarTransform4f().look_at(origin=[278, 273, -800], target=[278, 273, 0], up=[0, 1, 0])
    spectral = "spectral" in mi.variant()
    found = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": -1, "rr_depth": 5},
        "sensor": {
            "type": "perspective",
            "fov": float(np.degrees(2 * np.arctan(0.5 * 25 / 35))),
            "fov_axis": "y",
            "near_clip": 1.0,
            "far_clip": 1e5,
            "to_world": look,
            "film": {
                "type": "hdrfilm", "width": res, "height": res, "rfilter": {"type": "box"},
                "pixel_format": "xyz" if spectral else "rgb", "component_format": "float32",
            },
            "sampler": {"type": "independent", "sample_count": spp},
        },
    }
    for i, (name, material, corners) in enumerate(quads(scene)):
        emitter = mi.load_dict({"type": "area", "radiance": lamp}) if name == "lamp" else None
        found[f"{name}_{i}"] = quad_mesh(mi, f"{name}_{i}", corners, bsdf[material], emitter)
    if scene == "glass_metal":
        rgb = lambda c: {"type": "rgb", "value": list(c)}
        glass = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
        metal = {"type": "conductor", "eta": rgb(METAL_ETA), "k": rgb(METAL_K)}
        for name, ball, material in (("glass", GLASS, glass), ("metal", METAL, metal)):
            found[name] = {
                "type": "sphere", "center": list(ball["center"]), "radius": ball["radius"], "bsdf": material,
            }
    return mi.load_dict(found)


def regions(scene, res, sub=5):
    """Masks of the pixels that lie whole in one region, by casting rays at sub x sub points each."""
    at = (np.arange(res * sub) + 0.5) / (res * sub) - 0.5
    x, y = np.meshgrid(-at, -at)  # the camera looks along +z, so +x is to the left
    d = np.stack([x * 25 / 35, y * 25 / 35, np.ones_like(x)], -1)
    o = np.array([278.0, 273.0, -800.0])
    nearest, hit = np.full(x.shape, np.inf), np.full(x.shape, -1)
    names = []
    faces = [] if scene == "waves" else quads(scene)
    for name, _, corners in faces:
        if name not in names:
            names.append(name)
        c = np.asarray(corners, float)
        for tri in (c[[0, 1, 2]], c[[0, 2, 3]]):
            e1, e2 = tri[1] - tri[0], tri[2] - tri[0]
            p = np.cross(d, e2)
            det = p @ e1
            with np.errstate(divide="ignore", invalid="ignore"):
                u = p @ (o - tri[0]) / det
                q = np.cross(o - tri[0], e1)
                v = d @ q / det
                t = (q @ e2) / det
            ok = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (t < nearest)
            nearest[ok], hit[ok] = t[ok], names.index(name)
    if scene == "glass_metal":
        for ball in (GLASS, METAL):
            oc = o - np.asarray(ball["center"], float)
            a, b = (d * d).sum(-1), d @ oc
            disc = b * b - a * (oc @ oc - ball["radius"] ** 2)
            t = (-b - np.sqrt(np.maximum(disc, 0))) / a
            ok = (disc > 0) & (t < nearest)
            names.append("glass" if ball is GLASS else "metal")
            nearest[ok], hit[ok] = t[ok], len(names) - 1
    tiles = hit.reshape(res, sub, res, sub)
    low, high = tiles.min((1, 3)), tiles.max((1, 3))
    masks = {"whole": np.ones((res, res), bool)}
    for i, name in enumerate(names):
        masks[name] = (low == i) & (high == i)
    return masks


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", choices=SCENES)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--res", type=int, default=256)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--batches", type=int, default=64)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", required=True)
    args = parser.parse_args()
    import mitsuba as mi

    mi.set_variant(args.variant)
    scene = load(mi, args.scene, args.res, args.spp, waves_ply(pathlib.Path(args.out).with_name("waves.ply")))
    batches = []
    for i in range(args.batches):
        batches.append(np.array(mi.render(scene, spp=args.spp, seed=args.seed * 100_000 + i)))
    stack = np.stack(batches).astype(np.float32)
    np.save(args.out, stack)
    mean = stack.astype(float).mean((1, 2))
    print(args.scene, args.variant, "mean", mean.mean(0), "+-", mean.std(0, ddof=1) / len(mean) ** 0.5)


if __name__ == "__main__":
    main()
