// Writing results: never half a file, never over another one unasked.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace acdf::tools {

/// Checks finished bytes before they get their name; throws (for example Failure) to refuse them.
using Verify = std::function<void(const std::uint8_t* data, std::size_t size)>;

/// One output file. The bytes go to a temporary file beside it, which is fsynced and renamed by commit(). Where
/// commit() is not reached, also because of SIGINT, SIGTERM or SIGHUP, the temporary file is removed. What SIGKILL
/// or a power cut leaves, the next program that writes to that folder removes: temporary files that no running
/// program has locked (temporary.h).
/// "-" is stdout, and what exists but is no regular file (a pipe, a device) is written to directly.
class Output {
public:
    /// Fails early, before any long work. Throws Failure where `path` is a folder, is one of `inputs` (the same
    /// inode), exists and `force` is false, or lies in a folder that does not exist or cannot be written.
    Output(std::string path, bool force, const std::vector<std::string>& inputs = {});
    ~Output();
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    /// Appends. Throws Failure.
    void write(const void* data, std::size_t size);
    void write(const std::string& text) { write(text.data(), text.size()); }

    /// The path of the temporary file, for a library that writes files by name; it ends in the output's
    /// extension. Empty for stdout, pipes and devices.
    const std::string& temporary() const { return temporary_; }

    /// Reads the temporary file back, hands it to `verify`, and gives it its name. Throws Failure and whatever
    /// `verify` throws; the output then is as it was. (What went to stdout, a pipe or a device cannot be read
    /// back: use write_output for bytes that are to be verified.)
    void commit(const Verify& verify = {});

private:
    std::string path_;      // as the user gave it
    std::string target_;    // symbolic links resolved
    std::string temporary_; // empty: written directly
    std::FILE* stream_ = nullptr;
    bool force_ = false;
    unsigned mode_ = 0;
    unsigned owner_ = ~0u, group_ = ~0u; // of the file that is replaced; those of a new file stay as they are
    int lock_ = -1;                      // holds the lock on the temporary file

    void close();
    void unlock();
    void finish_temporary(const Verify& verify);
};

/// Removes the temporary files and empty folders of all outputs that are not finished, as before the program ends
/// at once. Allocates nothing.
void remove_unfinished() noexcept;

/// All of an output at once; `verify` runs for stdout, pipes and devices too.
void write_output(const std::string& path, const std::vector<std::uint8_t>& bytes, bool force,
                  const std::vector<std::string>& inputs = {}, const Verify& verify = {});

/// Makes a folder, and those above it, where they are missing. Throws Failure.
void make_folder(const std::string& path);

/// A folder for outputs, made with those above it where they are missing. Folders that were made are removed at the
/// end where they are empty: a command that fails, or that a signal ends, leaves none.
class OutputFolder {
public:
    /// Throws Failure.
    explicit OutputFolder(const std::string& path);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

private:
    void remove() const;

    std::vector<std::string> made_; ///< the deepest first
};

} // namespace acdf::tools
