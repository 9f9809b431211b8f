// make_batch_probes FOLDER COUNT [ROWS]: the library of small probes on which tools/batch/farm is tested.
#include "tests/tools/batch/files.h"

#include <cstdlib>

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    const auto number = [](const char* text) {
        return static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
    };
    acdf::test::write_small_probes(argv[1], number(argv[2]), argc > 3 ? number(argv[3]) : 8);
    return 0;
}
