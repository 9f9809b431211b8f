// Where a build has what its tests run and read. Not compiled into tests: another build may link their objects.
#pragma once

namespace acdf_test {

extern const char kTestData[];      ///< a folder with probes/ and brdfs/, if it exists
extern const char kProgram[];       ///< the acdf program
extern const char kImagesModule[];  ///< its module of OpenImageIO
extern const char kOpenExrModule[]; ///< its module of OpenEXR
extern const char kTextModule[];    ///< its module of FreeType
extern const char kOtherModule[];   ///< a module that is none of its
extern const char kMakeGolden[];    ///< the program that makes golden files
extern const char kExamples[];      ///< the folder of the programs of docs/examples

} // namespace acdf_test
