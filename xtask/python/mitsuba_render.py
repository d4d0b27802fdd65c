#!/usr/bin/env python3
"""Renders a scene several times with Mitsuba 3 for `cargo xtask peers`: one float image a run and a line of JSON.

    python mitsuba_render.py scenes/peers/mitsuba/g_cornell.xml --variant llvm_ad_rgb -D integrator=path \
        --spp 64 --runs 4 --seed 1 --out target/peers/g_cornell/mitsuba

Run k (from 0) uses the seed `seed + k` and lands in `OUT_k.npy` (float32, height × width × 3, linear sRGB). Of films with
more channels the first three are taken, of grey ones the first three times.
The JSON line on standard output gives the CPU and wall seconds of each run. They leave out Python's start, the
scene's loading and the compilation of kernels: a first image of the same size, thrown away, pays for those.
"""

import argparse
import json
import os
import resource
import time
from pathlib import Path


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--variant", choices=["scalar_rgb", "llvm_ad_rgb"], required=True)
    parser.add_argument("-D", dest="parameters", action="append", default=[], metavar="NAME=VALUE")
    parser.add_argument("--spp", type=int, required=True)
    parser.add_argument("--runs", type=int, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--resolution", metavar="WxH", help="instead of the scene's; of the same ratio of sides")
    parser.add_argument("--out", type=Path, required=True)
    args = parser.parse_args()

    point_at_llvm()
    import drjit as dr
    import mitsuba as mi
    import numpy as np

    mi.set_variant(args.variant)
    scene = mi.load_file(str(args.scene), **dict(pair.split("=", 1) for pair in args.parameters))
    if args.resolution:
        resize(mi, scene, [int(side) for side in args.resolution.split("x")])
    is_compiled = args.variant.startswith("llvm")

    def render(seed: int, spp: int) -> np.ndarray:
        image = np.array(mi.render(scene, seed=seed, spp=spp), dtype=np.float32)
        image = image.reshape(image.shape[0], image.shape[1], -1)
        image = np.ascontiguousarray(image[:, :, :3]) if image.shape[2] >= 3 else np.repeat(image[:, :, :1], 3, axis=2)
        if is_compiled:
            dr.sync_thread()
        return image

    warm_up_seed = args.seed + 500_000_000
    render(warm_up_seed, args.spp if is_compiled else 1)

    args.out.parent.mkdir(parents=True, exist_ok=True)
    cpu_seconds, wall_seconds = [], []
    for run in range(args.runs):
        cpu, wall = cpu_clock(), time.perf_counter()
        image = render(args.seed + run, args.spp)
        cpu_seconds.append(round(cpu_clock() - cpu, 4))
        wall_seconds.append(round(time.perf_counter() - wall, 4))
        np.save(f"{args.out}_{run}.npy", image)

    print(
        json.dumps(
            {
                "scene": args.scene.stem,
                "version": mi.__version__,
                "variant": args.variant,
                "parameters": args.parameters,
                "spp": args.spp,
                "runs": args.runs,
                "seed": args.seed,
                "resolution": args.resolution,
                "cpu_seconds": cpu_seconds,
                "wall_seconds": wall_seconds,
            }
        )
    )


def resize(mi, scene, size: list[int]) -> None:
    """Another size of the first sensor's film, whole: a crop window goes."""
    parameters = mi.traverse(scene.sensors()[0])
    parameters["film.size"] = size
    parameters["film.crop_size"] = size
    parameters["film.crop_offset"] = [0, 0]
    parameters.update()


def cpu_clock() -> float:
    """CPU seconds of all threads of this process so far."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def point_at_llvm() -> None:
    """Mitsuba picks the first LLVM it finds, and aborts on 15 and 16: name one that works."""
    for version in range(22, 16, -1):
        library = f"/usr/lib/x86_64-linux-gnu/libLLVM-{version}.so"
        if os.path.exists(library):
            os.environ.setdefault("DRJIT_LIBLLVM_PATH", library)
            return


if __name__ == "__main__":
    main()
