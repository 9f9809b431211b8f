"""Conan 2: `conan create lib/recipes/conan`, or with `-o acdf/*:builder=True` the builder, too."""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy


class Acdf(ConanFile):
    name = "acdf"
    version = "0.1.0"
    license = "BSD-3-Clause"
    description = "Compact importance sampling of measured light and reflectance"
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"builder": [True, False], "fPIC": [True, False]}
    default_options = {"builder": False, "fPIC": True}
    generators = "CMakeDeps"

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "..", "..", "..")
        for name in ("CMakeLists.txt", "LICENSE", "lib/*", "format/*"):
            copy(self, name, root, self.export_sources_folder)

    def config_options(self):
        if self.settings.os == "Windows":
            del self.options.fPIC

    def requirements(self):
        self.requires("zlib/[>=1.2.11 <2]")
        if self.options.builder:
            self.requires("onetbb/[>=2021]")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["ACDF_BUILD_BUILDER"] = bool(self.options.builder)
        for name in ("TOOLS", "TESTS", "PYTHON", "SHARED", "BATCH"):
            toolchain.cache_variables["ACDF_BUILD_" + name] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")  # its own acdfConfig.cmake
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "acdf")]
