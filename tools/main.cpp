// The program.
#include "tools/cli/output.h"
#include "tools/commands.h"

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include <cxxabi.h>
#include <fcntl.h>
#include <unistd.h>

namespace {

// The next file opened would take the place of a stream that is closed, and messages would go into it. What takes
// it instead cannot be read (stdin) or written (the others): using it remains an error.
void hold_closed_streams() {
    for (int stream = 0; stream <= 2; ++stream)
        if (fcntl(stream, F_GETFD) < 0) (void)!open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
}

std::terminate_handler terminate_otherwise = nullptr;

[[noreturn]] void end_with(const char* line) {
    (void)!write(STDERR_FILENO, line, std::strlen(line));
    acdf::tools::remove_unfinished();
    _exit(acdf::tools::exit_failed);
}

// Some functions of libraries promise not to throw, and end the program where memory or threads run out within
// them: as any other failure, by one line. Nothing here allocates.
[[noreturn]] void end_without_memory() {
    try {
        if (abi::__cxa_current_exception_type()) throw;
    } catch (const std::bad_alloc&) {
        end_with("acdf: out of memory; a smaller input or fewer --threads would help\n");
    } catch (const std::runtime_error& error) { // of oneTBB, where it starts a thread
        if (std::strstr(error.what(), "pthread_create"))
            end_with("acdf: no more threads can be started; more memory or fewer --threads would help\n");
    } catch (...) {
    }
    terminate_otherwise();
    _exit(acdf::tools::exit_failed);
}

} // namespace

int main(int argc, char** argv) {
    hold_closed_streams();
    terminate_otherwise = std::set_terminate(end_without_memory);
    return acdf::tools::run_program(argc, argv);
}
