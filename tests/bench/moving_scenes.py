#!/usr/bin/env python3
"""Times what bringing a scene to the next frame's time takes (updateScene): for mirrors that hover
and turn over a floor of 131,072 triangles, each by itself, and for a tube of triangles with a skin.

  tests/bench/moving_scenes.py [--frames N] [--instances N,N,...] [--skin TRIANGLES,...]
"""
import argparse
import base64
import json
import math
import pathlib
import struct
import tempfile

import turns

JOINTS = 20


def hovering(count):
    side = math.ceil(count ** (1 / 3))
    items = []
    for i in range(count):
        at = [i % side - side / 2, i // side % side, i // side // side - side / 2]
        items.append({"use": "gem", "transform": {"scale": 0.3, "translate": at},
                      "motion": {"loop": True, "keys": [
                          {"time": 0},
                          {"time": 2, "translate": [0, 0.2, 0]},
                          {"time": 4}]}})
    return {"whit": 1,
            "cameras": {"main": {"eye": [0, side, 2.2 * side + 2], "at": [0, side / 3, 0]}},
            "lights": [{"position": [side, 3 * side, side], "intensity": 12 * side * side}],
            "sky": {"color": 0.2}, "ambient": {"fromSky": 1},
            "materials": {"gem": {"mirror": 0.5}},
            "objects": {"gem": [{"shape": "icosphere", "level": 2, "material": "gem"}]},
            "scene": [{"shape": "canopy", "nx": 256, "ny": 256, "width": 8 * side, "depth": 8 * side,
                       "transform": {"translate": [0, -1, 0]}}] + items}


def swaying(triangles):
    """A tube that stands on a chain of joints, each of which turns; two joints hold a vertex."""
    data, views, accessors = bytearray(), [], []

    def add(numbers, code, component, kind, count, **more):
        packed = struct.pack(f"<{len(numbers)}{code}", *numbers)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        data.extend(packed)
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind,
                          "count": count, **more})
        return len(accessors) - 1

    around = 100
    rings = triangles // (2 * around) + 1
    positions, normals, joints, weights, indices = [], [], [], [], []
    for ring in range(rings):
        height = JOINTS * ring / (rings - 1)
        joint = min(int(height), JOINTS - 2)
        share = height - joint
        for i in range(around):
            x, z = math.cos(2 * math.pi * i / around), math.sin(2 * math.pi * i / around)
            positions += [x, height, z]
            normals += [x, 0, z]
            joints += [joint, joint + 1, 0, 0]
            weights += [1 - share, share, 0, 0]
            if ring < rings - 1:
                a, b = ring * around + i, ring * around + (i + 1) % around
                indices += [a, a + around, b, b, a + around, b + around]

    count = rings * around
    attributes = {"POSITION": add(positions, "f", 5126, "VEC3", count, min=[-1, 0, -1],
                             max=[1, JOINTS, 1]),
                  "NORMAL": add(normals, "f", 5126, "VEC3", count),
                  "JOINTS_0": add(joints, "H", 5123, "VEC4", count),
                  "WEIGHTS_0": add(weights, "f", 5126, "VEC4", count)}
    corners = add(indices, "I", 5125, "SCALAR", len(indices))
    inverse = [x for k in range(JOINTS) for x in [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -k, 0, 1]]
    bound = add(inverse, "f", 5126, "MAT4", JOINTS)
    times = add([0, 4], "f", 5126, "SCALAR", 2, min=[0], max=[4])
    sine, cosine = math.sin(0.05), math.cos(0.05)
    poses = add([0, 0, -sine, cosine, 0, 0, sine, cosine], "f", 5126, "VEC4", 2)

    bones = range(1, JOINTS + 1)
    nodes = [{"translation": [0, 1 if k > 1 else 0, 0], "children": [k + 1]} for k in bones]
    del nodes[-1]["children"]
    channels = [{"sampler": 0, "target": {"node": k, "path": "rotation"}} for k in bones]
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(data), "uri": uri}],
            "bufferViews": views, "accessors": accessors,
            "meshes": [{"primitives": [{"attributes": attributes, "indices": corners}]}],
            "skins": [{"joints": list(bones), "inverseBindMatrices": bound}],
            "nodes": [{"mesh": 0, "skin": 0}] + nodes, "scenes": [{"nodes": [0, 1]}], "scene": 0,
            "animations": [{"samplers": [{"input": times, "output": poses}], "channels": channels}]}


def numbers(text):
    return [int(word) for word in text.split(",") if word]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--frames", type=int, default=48)
    parser.add_argument("--instances", type=numbers, default=[1, 100, 10000])
    parser.add_argument("--skin", type=numbers, default=[100000])
    options = parser.parse_args()
    scenes = [(f"{n:,} mirrors over a floor", "json", hovering(n)) for n in options.instances]
    scenes += [(f"a skin of {n:,} triangles", "gltf", swaying(n)) for n in options.skin]
    print("| what moves | updateScene, ms | the frame, 480x300, ms |\n|---|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for what, kind, scene in scenes:
            path = pathlib.Path(folder) / f"moving.{kind}"
            path.write_text(json.dumps(scene))
            run = turns.run_whit("render", path, "--frames", f"0..{options.frames - 1}", "--size",
                                 "480x300", "-o", pathlib.Path(folder) / "####.png")
            print(f"| {what} | {run['updateScene_ms']:.1f} | {run['frame_ms']['median']:.1f} |",
                  flush=True)


if __name__ == "__main__":
    main()
