#include "calibration/tracking/camera_source.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <map>
#include <string_view>
#include <system_error>

#include <unistd.h>

namespace lumorph {

namespace {

namespace fs = std::filesystem;

std::string firstLine(const fs::path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    return line;
}

bool isNumber(const std::string& text) {
    return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool holds(const fs::path& process, const std::string& path) {
    std::error_code error;
    for (fs::directory_iterator file(process / "fd", error), end; !error && file != end; file.increment(error)) {
        std::error_code gone;
        if (fs::read_symlink(file->path(), gone) == path) return true;
    }
    return false;
}

/// The other program that has it open; programs of other users are not told.
std::string holderOf(const std::string& path) {
    std::error_code error;
    for (fs::directory_iterator entry("/proc", error), end; !error && entry != end; entry.increment(error)) {
        const std::string process = entry->path().filename().string();
        if (!isNumber(process) || process == std::to_string(getpid()) || !holds(entry->path(), path)) continue;
        const std::string name = firstLine(entry->path() / "comm");
        return (name.empty() ? "a program" : name) + " (process " + process + ")";
    }
    return {};
}

std::string listOf(const std::vector<CameraInfo>& cameras) {
    std::string list;
    for (const CameraInfo& camera : cameras)
        list += (list.empty() ? "" : ", ") + camera.path + " (" + camera.name + ")";
    return list;
}

} // namespace

std::vector<CameraInfo> listCameras(const fs::path& folder) {
    std::map<int, CameraInfo> byNumber;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string node = entry->path().filename().string();
        if (!node.starts_with("video") || !isNumber(node.substr(5)) || node.size() > 8) continue;
        // Further nodes of one camera give data about its pictures, not pictures.
        if (const std::string index = firstLine(entry->path() / "index"); !index.empty() && index != "0") continue;
        const std::string name = firstLine(entry->path() / "name");
        byNumber[std::stoi(node.substr(5))] = {"/dev/" + node, name.empty() ? "a camera" : name};
    }
    std::vector<CameraInfo> cameras;
    cameras.reserve(byNumber.size());
    for (auto& [number, camera] : byNumber) cameras.push_back(std::move(camera));
    return cameras;
}

bool isCameraPath(const std::string& source) { return source.starts_with("/dev/"); }

SourceFacts lookAt(const std::string& source) {
    SourceFacts facts;
    facts.isCamera = isCameraPath(source);
    facts.exists = access(source.c_str(), F_OK) == 0;
    facts.permitted = access(source.c_str(), facts.isCamera ? R_OK | W_OK : R_OK) == 0;
    if (!facts.isCamera) return facts;
    facts.cameras = listCameras();
    if (facts.permitted) facts.holder = holderOf(source);
    return facts;
}

std::string adviceFor(const std::string& source, const SourceFacts& facts) {
    if (!facts.isCamera) {
        if (!facts.exists) return "There is no file " + source + ". Check its path.";
        if (!facts.permitted) return "The file " + source + " may not be read by you. Change its permissions.";
        return "The file " + source + " is no video that can be read. Convert it, for example to MP4.";
    }
    if (!facts.exists)
        return "There is no camera at " + source + ". " +
               (facts.cameras.empty()
                    ? std::string("This machine sees none at all: plug one in; it is found by itself.")
                    : "Those that are there: " + listOf(facts.cameras) + ".");
    if (!facts.permitted)
        return "You may not use the camera at " + source + ". Join the group video (sudo usermod -aG video $USER), " +
               "then log out and in again.";
    if (!facts.holder.empty())
        return "The camera at " + source + " is in use by " + facts.holder + ". Close that; it is tried again.";
    return "The camera at " + source + " gives no pictures. Check that no other program uses it, then unplug it and " +
           "plug it in again.";
}

} // namespace lumorph
