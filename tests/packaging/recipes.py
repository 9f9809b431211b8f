#!/usr/bin/env python3
"""recipes.py ROOT CMAKE [--wheel]: what pyproject.toml, the vcpkg port and the Conan recipe say, as far as it can be checked without
their programs: versions are those of the project, and CMake takes the options, configures with them and installs what they
name. `--wheel` builds the wheel's contents, too, and samples from them (minutes)."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

try:
    import tomllib
except ImportError:  # before Python 3.11
    tomllib = None


def configured(cmake, root, build, options):
    """Configures as the top project; fails for variables that the project does not know. Returns the folder."""
    run = subprocess.run([cmake, "-S", root, "-B", build, "-DCMAKE_BUILD_TYPE=Release", *options], capture_output=True, text=True)
    told = run.stdout + run.stderr
    if run.returncode or "not used by the project" in told:
        raise SystemExit(f"{' '.join(options)}:\n{told}")
    return build


def installs(build):
    """What the rules of installation name, with their components."""
    return "".join(path.read_text() for path in pathlib.Path(build).rglob("cmake_install.cmake"))


def require(condition, what):
    if not condition:
        raise SystemExit(what)


def check_vcpkg(root, cmake, work, version):
    port = root / "lib/recipes/vcpkg"
    manifest = json.loads((port / "vcpkg.json").read_text())
    require(manifest["version-semver"] == version, "vcpkg.json: another version than CMakeLists.txt")
    text = (port / "portfile.cmake").read_text()
    features = dict(re.findall(r"(\w+) (ACDF_BUILD_\w+)", re.search(r"FEATURES([^)]*)\)", text).group(1)))
    require(set(features) == set(manifest["features"]), "portfile.cmake and vcpkg.json differ in their features")
    options = re.findall(r"-D\w+=\w+", text)
    folder = re.search(r"CONFIG_PATH ([\w/]+)", text).group(1)
    for turned in ("OFF", "ON"):
        build = configured(cmake, root, f"{work}/vcpkg_{turned}",
                           [*options, "-DCMAKE_INSTALL_LIBDIR=lib", *[f"-D{option}={turned}" for option in features.values()]])
        rules = installs(build)
        require(folder + '"' in rules, f"nothing is installed into {folder}")
        require(("libacdf-builder.a" in rules) == (turned == "ON"), "the builder is not what the feature turns on")


def check_conan(root, cmake, work, version):
    text = (root / "lib/recipes/conan/conanfile.py").read_text()
    compile(text, "conanfile.py", "exec")
    require(f'version = "{version}"' in text, "conanfile.py: another version than CMakeLists.txt")
    names = re.search(r"for name in \(([^)]*)\):\n\s+toolchain", text).group(1)
    options = [f"-DACDF_BUILD_{name}=OFF" for name in re.findall(r'"(\w+)"', names)]
    exported = re.findall(r'"([^"]+)"', re.search(r"for name in \(([^)]*)\):\n\s+copy", text).group(1))
    sources = pathlib.Path(work) / "conan"  # only what the recipe takes along
    sources.mkdir(parents=True)
    for name in exported:
        target = name.rstrip("/*")
        (sources / target).symlink_to(root / target)
    build = configured(cmake, str(sources), f"{work}/conan_build", [*options, "-DACDF_BUILD_BUILDER=ON"])
    require("acdfConfig.cmake" in installs(build), "conanfile.py: acdfConfig.cmake is not installed")


def wheel_options(project):
    backend = project["tool"]["scikit-build"]
    return ["-DSKBUILD=2", *[f"-D{name}={value}" for name, value in backend["cmake"]["define"].items()]]


def check_pyproject(root, cmake, work, version):
    """Configures as scikit-build-core does; returns the folder and the tables."""
    project = tomllib.loads((root / "pyproject.toml").read_text())
    require(project["project"]["version"] == version, "pyproject.toml: another version than CMakeLists.txt")
    require(project["build-system"]["build-backend"] == "scikit_build_core.build", "pyproject.toml: another backend")
    require((root / project["project"]["readme"]).is_file() and (root / project["project"]["license"]["file"]).is_file(),
            "pyproject.toml: readme or license is missing")
    build = configured(cmake, root, f"{work}/wheel", wheel_options(project))
    rules = installs(build)
    for component in project["tool"]["scikit-build"]["install"]["components"]:
        require(f'STREQUAL "{component}"' in rules, f"nothing is installed of {component}")
    return build, project


def check_wheel(cmake, work, build, project):
    backend, contents = project["tool"]["scikit-build"], f"{work}/contents"
    for target in backend["cmake"]["targets"]:
        subprocess.run([cmake, "--build", build, "--target", target, "--parallel", str(os.cpu_count() or 1)], check=True, stdout=subprocess.DEVNULL)
    for component in backend["install"]["components"]:
        subprocess.run([cmake, "--install", build, "--prefix", contents, "--component", component], check=True,
                       stdout=subprocess.DEVNULL)
    wheel = f"{work}/acdf.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        for path in sorted(pathlib.Path(contents).rglob("*")):
            archive.write(path, path.relative_to(contents))
        names = archive.namelist()
    require({"acdf/__init__.py", "acdf/py.typed", "acdf/_acdf.pyi"} <= set(names), f"the wheel lacks files: {names}")
    require(all(name.startswith("acdf") for name in names), f"the wheel has more than the package: {names}")
    environment = {**os.environ, "PYTHONPATH": contents}
    subprocess.run([os.environ.get("PYTHON", "/usr/bin/python3"), "-c", "import acdf, numpy; s = acdf.build_environment("
                    "numpy.ones((8, 16), numpy.float32)); d, p = s.sample(numpy.random.rand(9, 2)); assert (s.pdf(d) == p).all()"],
                   check=True, env=environment)


def check(root, cmake, work, *flags):
    root = pathlib.Path(root).resolve()
    version = re.search(r"project\(acdf VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text()).group(1)
    check_vcpkg(root, cmake, work, version)
    check_conan(root, cmake, work, version)
    if tomllib is None:
        print("pyproject.toml is not read: Python is older than 3.11")
        return
    build, project = check_pyproject(root, cmake, work, version)
    if "--wheel" in flags:
        check_wheel(cmake, work, build, project)
    print("recipes are right" + (", and so is the wheel" if "--wheel" in flags else ""))


def main(root, cmake, *flags):
    with tempfile.TemporaryDirectory() as work:
        check(root, cmake, work, *flags)


if __name__ == "__main__":
    main(*sys.argv[1:])
