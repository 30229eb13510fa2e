#include "calibration/lab/lab_folder.h"

#include <cerrno>
#include <cstddef>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace lumorph {

namespace fs = std::filesystem;

namespace {

void writeBytes(const fs::path& file, std::span<const std::byte> bytes) {
    errno = 0;
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) throwWriteError(file, errno != 0 ? errno : EIO);
}

} // namespace

LabFolder::LabFolder(fs::path target) : target_(std::move(target)) {
    std::error_code error;
    if (target_.filename().empty()) target_ = target_.parent_path();
    if (fs::exists(target_, error) && !(fs::is_directory(target_, error) && fs::is_empty(target_, error)))
        throw InvalidInput(target_.string(), "is there already and not an empty folder",
                           "name a new folder, or empty this one");
    const fs::path parent = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    fs::create_directories(parent, error);
    if (error) throwWriteError(parent, error.value());
    place_ = parent / (".lumorph-" + std::to_string(::getpid()) + "-" + target_.filename().string() + ".part");
    fs::create_directory(place_, error);
    if (error) throwWriteError(place_, error.value());
}

LabFolder::~LabFolder() {
    std::error_code ignored;
    if (!place_.empty()) fs::remove_all(place_, ignored);
}

void LabFolder::write(const std::vector<LabShot>& shots, const Progress& progress) const {
    if (shots.empty()) return;
    const fs::path view = place_ / shots.front().view;
    std::error_code error;
    fs::create_directory(view, error);
    if (error) throwWriteError(view, error.value());
    tbb::parallel_for(std::size_t{0}, shots.size(), [&](std::size_t i) {
        if (progress.cancelled()) return;
        std::vector<uchar> bytes; // grey in one channel, packed for speed: noise hardly packs
        cv::imencode(".png", shots[i].grey, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
        writeBytes(view / shots[i].file, std::as_bytes(std::span(bytes)));
    });
    progress.throwIfCancelled();
}

void LabFolder::write(const std::string& file, const std::string& text) const {
    writeBytes(place_ / file, std::as_bytes(std::span(text)));
}

void LabFolder::finish() {
    std::error_code error;
    fs::rename(place_, target_, error); // takes the place of an empty folder
    if (error) throwWriteError(target_, error.value());
    place_.clear();
}

} // namespace lumorph
