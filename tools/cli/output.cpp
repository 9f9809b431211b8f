#include "tools/cli/output.h"

#include "tools/cli/temporary.h"
#include "tools/commands.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace acdf::tools {
namespace {

// ---- removal of temporary files when a signal ends the program -----------------------------------------

std::atomic<const char*> doomed[256];        // paths to unlink; lock-free, as a signal handler needs
std::atomic<const char*> doomed_folders[64]; // to remove where they are empty by then, the deepest first
static_assert(std::atomic<const char*>::is_always_lock_free);

} // namespace

void remove_unfinished() noexcept {
    for (const auto& slot : doomed)
        if (const char* path = slot.load()) unlink(path);
    for (const auto& slot : doomed_folders)
        if (const char* path = slot.load()) rmdir(path);
}

namespace {

void remove_and_die(int signal) {
    remove_unfinished();
    std::signal(signal, SIG_DFL);
    raise(signal);
}

void handle_signals() {
    static const bool once = [] {
        std::signal(SIGXFSZ, SIG_IGN); // a limit on file sizes is an error of write, reported like a full disk
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
            struct sigaction action = {};
            sigaction(signal, nullptr, &action);
            if (action.sa_handler == SIG_IGN) continue; // nohup
            action = {};
            action.sa_handler = remove_and_die;
            sigaction(signal, &action, nullptr);
        }
        return true;
    }();
    (void)once;
}

template <std::size_t N>
void remove_on_signal(std::atomic<const char*> (&slots)[N], const std::string& path) {
    handle_signals();
    for (auto& slot : slots) {
        const char* expected = nullptr;
        if (slot.compare_exchange_strong(expected, path.c_str())) return;
    }
}

template <std::size_t N>
void keep_on_signal(std::atomic<const char*> (&slots)[N], const std::string& path) {
    for (auto& slot : slots) {
        const char* expected = path.c_str();
        if (slot.compare_exchange_strong(expected, nullptr)) return;
    }
}

// ---- helpers -------------------------------------------------------------------------------------------

[[noreturn]] void fail(const std::string& path, const std::string& what) {
    throw Failure((path == "-" ? "stdout" : path) + ": " + what);
}

[[noreturn]] void fail_errno(const std::string& path, const std::string& what, int error) {
    const char* help = error == ENOSPC || error == EDQUOT || error == EFBIG ? "; free some space or write elsewhere"
                       : error == EACCES || error == EPERM || error == EROFS
                           ? "; choose a folder that you may write to"
                           : "";
    fail(path, what + ": " + std::strerror(error) + help);
}

bool same_file(const struct stat& a, const std::string& path) {
    struct stat b = {};
    return stat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

std::string folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

// Where a path leads, also through links to what does not exist yet: the link stays, and its target is made.
std::string follow_links(const std::string& path) {
    std::filesystem::path at = path;
    std::error_code error;
    for (int links = 0; std::filesystem::is_symlink(at, error); ++links) {
        if (links == 40) fail(path, "is a symbolic link in a circle; choose another output");
        at = at.parent_path() / std::filesystem::read_symlink(at, error); // an absolute one stands alone
        if (error) fail(path, "cannot read the symbolic link: " + error.message());
    }
    return at.string();
}

unsigned default_mode() {
    const mode_t mask = umask(0);
    umask(mask);
    return 0666u & ~mask;
}

// Some file systems have no fsync for a folder (EINVAL): there is nothing better to do then.
void sync_folder(const std::string& folder) {
    const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) return;
    fsync(fd);
    ::close(fd);
}

// Without force the rename itself refuses to replace, so that a file that appeared meanwhile survives. Where the
// file system cannot do that, an ordinary rename follows a check.
bool rename_file(const std::string& from, const std::string& to, bool force) {
    if (force) return std::rename(from.c_str(), to.c_str()) == 0;
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
    if (errno != EINVAL && errno != ENOSYS) return false;
    if (access(to.c_str(), F_OK) == 0) {
        errno = EEXIST;
        return false;
    }
    return std::rename(from.c_str(), to.c_str()) == 0;
}

// Once a folder: programs that write many files to one do not list it for each.
void sweep(const std::string& folder) {
    static std::mutex mutex;
    static std::set<std::string> swept;
    const std::lock_guard<std::mutex> lock(mutex);
    if (swept.insert(folder).second) remove_stale_temporaries(folder);
}

std::vector<std::uint8_t> read_descriptor(int fd, const std::string& path) {
    std::vector<std::uint8_t> bytes;
    std::uint8_t buffer[65536];
    for (;;) {
        const ssize_t n = read(fd, buffer, sizeof(buffer));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail_errno(path, "cannot read back what was written", errno);
        if (n == 0) return bytes;
        bytes.insert(bytes.end(), buffer, buffer + n);
    }
}

} // namespace

Output::Output(std::string path, bool force, const std::vector<std::string>& inputs)
    : path_(std::move(path)), target_(path_), force_(force) {
    if (path_ == "-") {
        stream_ = stdout;
        return;
    }
    if (path_.empty()) throw Failure("-o: the output has no name; give a file, or - for stdout");
    struct stat status = {};
    const bool exists = stat(path_.c_str(), &status) == 0;
    if (exists) {
        if (S_ISDIR(status.st_mode)) fail(path_, "is a folder; give the name of a file in it");
        for (const std::string& input : inputs)
            if (input != "-" && same_file(status, input))
                fail(path_, "input and output are the same file; choose another output");
        if (!S_ISREG(status.st_mode)) {
            stream_ = std::fopen(path_.c_str(), "wb");
            if (!stream_) fail_errno(path_, "cannot open for writing", errno);
            return;
        }
        if (!force_) fail(path_, "exists already; use --force to replace it");
    }
    target_ = follow_links(path_);
    const std::string folder = folder_of(target_);
    if (access(folder.c_str(), F_OK) != 0) fail(path_, "the folder " + folder + " does not exist; create it first");

    mode_ = exists ? status.st_mode & 07777u : default_mode();
    if (exists) owner_ = status.st_uid, group_ = status.st_gid;
    const std::string extension = std::filesystem::path(target_).extension().string();
    sweep(folder);
    const int fd = create_temporary(folder, extension, temporary_);
    if (fd < 0) fail_errno(path_, "cannot create a file in " + folder, errno);
    remove_on_signal(doomed, temporary_);
    lock_ = fcntl(fd, F_DUPFD_CLOEXEC, 0); // the lock outlives the stream
    stream_ = fdopen(fd, "wb");
}

Output::~Output() {
    if (stream_ && stream_ != stdout) std::fclose(stream_);
    if (temporary_.empty()) return;
    unlink(temporary_.c_str());
    keep_on_signal(doomed, temporary_);
    unlock();
}

void Output::unlock() {
    if (lock_ >= 0) ::close(lock_);
    lock_ = -1;
}

void Output::write(const void* data, std::size_t size) {
    if (std::fwrite(data, 1, size, stream_) != size) fail_errno(path_, "cannot write", errno);
}

void Output::close() {
    std::FILE* stream = stream_;
    stream_ = nullptr;
    if ((stream == stdout ? std::fflush(stream) : std::fclose(stream)) != 0)
        fail_errno(path_, "cannot write", errno);
}

void Output::finish_temporary(const Verify& verify) {
    const int fd = open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) fail_errno(path_, "cannot read back what was written", errno);
    try {
        if (verify) {
            const std::vector<std::uint8_t> bytes = read_descriptor(fd, path_);
            verify(bytes.data(), bytes.size());
        }
        if (fchown(fd, owner_, group_) != 0) mode_ &= 0777u; // another user's: to run as them is not ours to grant
        if (fchmod(fd, mode_) != 0) fail_errno(path_, "cannot set permissions", errno);
        if (fsync(fd) != 0 && errno != EINVAL) fail_errno(path_, "cannot write", errno);
    } catch (...) {
        ::close(fd);
        throw;
    }
    ::close(fd);
}

void Output::commit(const Verify& verify) {
    close();
    if (temporary_.empty()) return;
    finish_temporary(verify);
    if (!rename_file(temporary_, target_, force_)) {
        if (errno == EEXIST) fail(path_, "appeared while it was being made; use --force to replace it");
        fail_errno(path_, "cannot give the finished file its name", errno);
    }
    keep_on_signal(doomed, temporary_);
    temporary_.clear();
    unlock();
    sync_folder(folder_of(target_));
}

void write_output(const std::string& path, const std::vector<std::uint8_t>& bytes, bool force,
                  const std::vector<std::string>& inputs, const Verify& verify) {
    Output output(path, force, inputs);
    const bool readable = !output.temporary().empty();
    if (verify && !readable) verify(bytes.data(), bytes.size());
    output.write(bytes.data(), bytes.size());
    output.commit(readable ? verify : Verify{});
}

void make_folder(const std::string& path) {
    if (path == "-") fail(path, "is not a folder; give one to write to");
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) fail(path, "cannot make this folder: " + error.message());
    if (!std::filesystem::is_directory(path, error)) fail(path, "is not a folder; give one to write to");
}

OutputFolder::OutputFolder(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    for (fs::path missing = path; !missing.empty() && !fs::exists(missing, error); missing = missing.parent_path())
        made_.push_back(missing.string());
    for (const std::string& folder : made_) remove_on_signal(doomed_folders, folder);
    try {
        make_folder(path);
    } catch (...) {
        remove();
        throw;
    }
}

OutputFolder::~OutputFolder() { remove(); }

void OutputFolder::remove() const {
    for (const std::string& folder : made_) {
        rmdir(folder.c_str());
        keep_on_signal(doomed_folders, folder);
    }
}

} // namespace acdf::tools
