#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include <glm/vec2.hpp>

#include "core/base/image.h"

namespace lumorph {

/// Writes pictures as an MP4 video: H.264, or MPEG-4 Part 2 where no H.264 encoder is installed. The file appears under
/// its name only when `finish` has returned; until then, and when something goes wrong, there is none and an older file
/// of that name stays. What was written until then has no name on file systems that allow it, so that nothing is left
/// even of a program that is killed.
class VideoWriter {
public:
    /// `size` in pixels, both sides even and in [16, 8192]; `framesPerSecond` in [1, 240]. Throws InvalidInput for
    /// others or a name that does not end in .mp4, DeviceError when the folder cannot be written or no encoder is
    /// installed.
    VideoWriter(std::filesystem::path file, glm::ivec2 size, double framesPerSecond);
    ~VideoWriter(); ///< without `finish`, nothing is left
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// Appends one frame of exactly the video's size; alpha is left out. Throws InvalidInput for another size.
    void add(const Image& frame);
    /// Appends sound, which begins with the first frame: left and right by turns, `kSoundRate` a second. A video in
    /// which nothing is heard gets no track.
    void addSound(std::span<const std::int16_t> samples);
    [[nodiscard]] int frames() const noexcept;

    /// Closes the file, looks whether it opens again with every frame in it, and gives it its name. Throws DeviceError
    /// when the disk was full, InvalidInput without a single frame.
    void finish();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// The nearest size not above `size` that a video can have: even sides, at least 16.
[[nodiscard]] glm::ivec2 evenSize(glm::ivec2 size) noexcept;

} // namespace lumorph
