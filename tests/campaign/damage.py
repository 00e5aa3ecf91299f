# SPDX-License-Identifier: MIT
"""Files of each kind that the program reads, and how they are damaged: cut, bits turned, parts of others put in, fields of JSON set to numbers
that are out of any range, the same in binary headers."""
import base64
import json
import signal
import struct
import time

from common import Run, must, run

NUMBERS = (0, -1, 2 ** 31, 2 ** 32, 2 ** 62, 1e308, float("nan"), 0.5, "", [], {}, None, True)
SIZES = ("count", "byteOffset", "byteLength", "byteStride", "bufferView", "componentType", "type", "POSITION", "indices")
WORDS = (0, 1, 0x7fffffff, 0x80000000, 0xffffffff)  # of four bytes in a binary file
SCENES = ("cornell-box", "lights", "skin", "lobes", "foggy", "cloud", "arrows", "instanced")
LARGEST = 200_000  # bytes
TINY = "--resolution 8,8 --spp 1 --quiet".split()


def contained(ground, path):
    """A scene of the repository with its buffers and pictures inside."""
    root = json.loads(path.read_text())
    for part in root.get("buffers", []) + root.get("images", []):
        if "uri" in part and not part["uri"].startswith("data:"):
            data = (ground.scenes / part["uri"]).read_bytes()
            kind = "image/png" if part["uri"].endswith(".png") else "application/octet-stream"
            part["uri"] = f"data:{kind};base64," + base64.b64encode(data).decode()
    return json.dumps(root).encode()


def seeds(ground):
    """Kind: whole files of it."""
    import make_corpus
    files = {kind: [] for kind in ("gltf", "glb", "bin", "config", "checkpoint", "part.exr", "nvdb", "png", "jpg", "hdr", "exr", "webp", "pfm")}
    for path in sorted(ground.scenes.glob("*.gltf")):
        if path.stat().st_size < LARGEST / 4 and len(text := contained(ground, path)) < LARGEST:
            files["gltf"].append(text)
    for scene, binary in (make_corpus.feature_scene(), make_corpus.motion_scene(), make_corpus.instancing_scene()):
        files["glb"].append(make_corpus.glb(scene, binary))
        files["gltf"].append(json.dumps(scene | {"buffers": [{"byteLength": len(binary), "uri": "data:application/octet-stream;base64," +
                                                              base64.b64encode(binary).decode()}]}).encode())
        files["bin"].append((scene, binary))
    for name, data in make_corpus.pictures():
        kind = name.rpartition(".")[2]
        files.get({"vp8": "webp", "vp8x": "webp"}.get(kind, kind), []).append(data)
    files["png"] += [path.read_bytes() for path in sorted(ground.scenes.glob("*.png")) if path.stat().st_size < LARGEST]
    files["nvdb"].append((ground.scenes / "plume.nvdb").read_bytes())
    files["config"] += [json.dumps(config).encode() for config in (
        {"resolution": [8, 8], "spp": 1, "stage": "gi", "bounces": 3}, {"studio": "softbox", "exposure": 1.5, "tone-map": "agx"},
        {"camera-position": [0, 1, 4], "camera-focal-point": [0, 0, 0], "fit": True, "noise": 0.1, "aov": "albedo,depth"},
        {"sky": True, "sun-elevation": 20, "fog-density": 0.1, "disable": ["reflections"], "hide": "x", "memory-limit": "1GB"})]
    files |= drawn(ground)
    return files


def drawn(ground):
    """Returns good files that the program itself writes."""
    box = ground.scenes / "cornell-box.gltf"
    made = {}
    for kind in ("png", "jpg", "hdr", "exr", "pfm"):
        must(run(ground, ["render", box, "-o", f"d.{kind}", *TINY, "--seed", "3"], ground.folder), 0)
        made[kind] = [(ground.folder / f"d.{kind}").read_bytes()]
    must(run(ground, ["render", box, "-o", "p.exr", *TINY, "--sample-offset", "1", "--aov", "albedo"], ground.folder), 0)
    made["part.exr"] = [(ground.folder / "p.exr").read_bytes()]
    # A render of an hour that is given three seconds writes a checkpoint on its way.
    path = ground.folder / "c.exr.checkpoint"
    path.unlink(missing_ok=True)
    with Run(["render", box, "-o", "c.exr", "--checkpoint", "0.1", "--resolution", "8,8", "--spp", "1000000", "--quiet"], ground.folder, program=ground.fragtrace) as process:
        while not path.exists() and process.process.poll() is None:
            time.sleep(0.02)
        process.process.send_signal(signal.SIGINT)
        process.wait(60)
    made["checkpoint"] = [path.read_bytes()]
    return made


def places(value, path=()):
    """The paths of all members and elements."""
    found = [path] if path else []
    for key, member in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        found += places(member, (*path, key))
    return found


def with_numbers(root, dice):
    """Some members set to what they must not be, or taken away."""
    root = json.loads(json.dumps(root))
    for _ in range(dice.choice((1, 1, 1, 2, 4))):
        every = places(root)
        if not every:
            break
        sizes = [one for one in every if one[-1] in SIZES]
        *path, last = dice.choice(sizes if sizes and dice.random() < 0.5 else every)
        place = root
        for step in path:
            place = place[step]
        if dice.random() < 0.1:
            del place[last]
        elif dice.random() < 0.4 and isinstance(place[last], (int, float)):
            place[last] = dice.choice((place[last] - 1, place[last] + 1, 2 * place[last], place[last] + 1000, 100_000, 1_000_000))
        else:
            place[last] = dice.choice(NUMBERS)
    return root


def bytes_damaged(data, others, dice):
    data = bytearray(data)
    for _ in range(dice.choice((1, 1, 2, 5))):
        if not data:
            break
        at = dice.randrange(len(data))
        kind = dice.choice(("cut", "bit", "bit", "bits", "splice", "word", "word", "twice"))
        if kind == "cut":
            del data[at:]
        elif kind == "bit":
            data[min(at, len(data) - 1)] ^= 1 << dice.randrange(8)
        elif kind == "bits":
            for _ in range(20):
                data[dice.randrange(len(data))] = dice.randrange(256)
        elif kind == "splice":
            other = dice.choice(others)
            first = dice.randrange(len(other) + 1)
            data[at:at + dice.randrange(64)] = other[first:first + dice.randrange(256)]
        elif kind == "word":
            # Headers, which hold sizes and counts, are at the beginning.
            at = dice.randrange(min(len(data), 256)) if dice.random() < 0.7 else at
            data[at:at + 4] = struct.pack(dice.choice("<>") + "I", dice.choice(WORDS))
        else:
            data[at:at] = data[at:at + dice.randrange(512)]
    return bytes(data)


def damaged(kind, files, dice):
    """A damaged file of that kind; of a binary, its scene and the damaged bytes."""
    whole = dice.choice(files[kind])
    if kind == "bin":
        return whole[0], bytes_damaged(whole[1], [binary for _, binary in files[kind]], dice)
    if kind in ("gltf", "config") and dice.random() < 0.75:
        return json.dumps(with_numbers(json.loads(whole), dice)).encode()
    if kind == "glb" and dice.random() < 0.5:
        import make_corpus
        size = struct.unpack_from("<I", whole, 12)[0]
        return make_corpus.glb(with_numbers(json.loads(whole[20:20 + size]), dice), whole[28 + size:])
    return bytes_damaged(whole, files[kind], dice)
