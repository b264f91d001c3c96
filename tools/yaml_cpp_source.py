"""Fetch the sources of yaml-cpp from the package index: python tools/yaml_cpp_source.py FOLDER

They lie in the source distribution of the wheel that the ordinary build uses. pip builds it once before it hands the
archive over, which takes a minute. Prints the folder for -DARM3R_YAML_SOURCE."""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
from pathlib import Path

REQUIREMENT = "cmeel-yaml-cpp==0.8.0"
ENVIRONMENT = {
    "CMAKE_POLICY_VERSION_MINIMUM": "3.5",  # its CMakeLists.txt is older than CMake 4 likes
    "CMEEL_CMAKE_ARGS": "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DYAML_CPP_BUILD_TOOLS=OFF",  # nobody uses what pip builds
}


def main(folder: Path) -> int:
    source = folder / "yaml-cpp"
    if not (source / "src").is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "download", "--quiet", "--no-deps"]
        subprocess.run(
            [*pip, "--no-binary", "cmeel-yaml-cpp", "--dest", folder, REQUIREMENT],
            check=True,
            env=os.environ | ENVIRONMENT,
        )
        (archive,) = folder.glob("cmeel*yaml*cpp-*.tar.gz")
        with tarfile.open(archive) as contents:
            wanted = [member for member in contents if member.name.split("/")[1:2] == ["yaml-cpp"]]
            for member in wanted:
                member.name = member.name.split("/", 1)[1]
            contents.extractall(folder, members=wanted)
    print(source)
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
