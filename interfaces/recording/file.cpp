#include "interfaces/recording/file.hpp"
#include "interfaces/recording/mcap_records.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace recording {

OutputFile::OutputFile(std::string path, bool replace)
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(),
                         O_WRONLY | O_CREAT | O_CLOEXEC | (replace ? O_TRUNC : O_EXCL), 0644)) {
  if (descriptor_ >= 0) return;
  const int error = errno;
  if (error == EEXIST)
    throw RecordingError(path_ + ": the file exists already; move it or choose another name");
  fail("create", error);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::fail(const char* doing, int error) const {
  throw WriteError(path_ + ": cannot " + doing + ": " + std::strerror(error) +
                   (error == ENOSPC ? "; free some space or record elsewhere"
                                    : "; check the folder and its permissions"));
}

void OutputFile::append(ByteView bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      const auto size = static_cast<off_t>(size_);
      if (::ftruncate(descriptor_, size) == 0) ::lseek(descriptor_, size, SEEK_SET);
      fail("write", error);
    }
    done += static_cast<std::size_t>(n);
  }
  size_ += bytes.size();
  crc_ = crc32_of(bytes, crc_);
}

void OutputFile::sync() {
  // EINVAL: a pipe or a device, which cannot be synchronized.
  if (::fdatasync(descriptor_) < 0 && errno != EINVAL && errno != EROFS) fail("sync", errno);
}

void OutputFile::close() {
  sync();
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) < 0) fail("close", errno);
}

void OutputFile::remove() {
  struct stat status {};
  const bool is_file = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  ::close(std::exchange(descriptor_, -1));
  if (is_file) ::unlink(path_.c_str());
}

InputFile::InputFile(std::string path)
    : path_(std::move(path)),
      // O_NONBLOCK: opening a pipe does not wait for its writer.
      descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0)
    throw RecordingError(path_ + ": cannot open: " + std::strerror(errno) + "; check the name");
  struct stat status {};
  if (::fstat(descriptor_, &status) < 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw RecordingError(path_ + ": is not a file; give the name of a recording");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

Bytes InputFile::read(std::uint64_t offset, std::uint64_t size) const {
  if (offset > size_ || size > size_ - offset)
    throw error_at(path_, offset, "the file ends here, " + std::to_string(size) + " bytes early",
                   recover_remedy(path_));
  Bytes out(static_cast<std::size_t>(size));
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t n = ::pread(descriptor_, out.data() + done, out.size() - done,
                              static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0)
      throw error_at(path_, offset + done,
                     n < 0 ? std::strerror(errno) : "the file became shorter while it was read",
                     "read a copy");
    done += static_cast<std::size_t>(n);
  }
  return out;
}

}  // namespace recording
