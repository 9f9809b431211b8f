// Where this build has what tests run and read (tests/inputs/paths.h).
#include "tests/inputs/paths.h"

namespace acdf_test {
const char kTestData[] = ACDF_TEST_DATA;
#ifdef ACDF_PROGRAM
const char kProgram[] = ACDF_PROGRAM;
const char kImagesModule[] = ACDF_IMAGES_MODULE;
const char kOpenExrModule[] = ACDF_OPENEXR_MODULE;
const char kTextModule[] = ACDF_TEXT_MODULE;
const char kOtherModule[] = ACDF_OTHER_MODULE;
const char kMakeGolden[] = ACDF_MAKE_GOLDEN;
const char kExamples[] = ACDF_EXAMPLES;
#endif
} // namespace acdf_test

#ifdef ACDF_PROGRAM
// Where the modules are that lib/images opens (lib/images/module.cpp): only the program itself finds them from
// where it lies.
extern "C" {
extern const char acdf_images_folder[];
const char acdf_images_folder[] = ACDF_IMAGES_FOLDER;
}
#endif
