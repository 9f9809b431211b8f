// The program.
#include "tools/commands.h"

#include <fcntl.h>

namespace {

// The next file opened would take the place of a stream that is closed, and messages would go into it. What takes
// it instead cannot be read (stdin) or written (the others): using it remains an error.
void hold_closed_streams() {
    for (int stream = 0; stream <= 2; ++stream)
        if (fcntl(stream, F_GETFD) < 0) (void)!open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
}

} // namespace

int main(int argc, char** argv) {
    hold_closed_streams();
    return acdf::tools::run_program(argc, argv);
}
