#include <algorithm>
#include <charconv>
#include <span>
#include <sstream>

#include "app/recording/recording.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

// The shortest text that gives the same number again, with a point in every language.
std::string number(double value) {
    char text[32];
    const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
    return {std::begin(text), end};
}

std::string seconds(Microseconds time) { return number(static_cast<double>(time.count()) / 1e6); }

std::string numbered(const char* name, std::size_t count) {
    std::string header;
    for (std::size_t i = 0; i < count; ++i) header += ',' + (name + std::to_string(i));
    return header;
}

constexpr std::size_t kExportRowsBetweenLooks = 1024;

/// Tells how far a table is, and stops where the user wants it.
class Lines {
public:
    Lines(const Progress& progress, std::size_t all, const char* name) : progress_(progress), all_(all), name_(name) {}
    void step() {
        if (++done_ % kExportRowsBetweenLooks != 0) return;
        progress_.throwIfCancelled();
        progress_.report(static_cast<double>(done_) / static_cast<double>(all_), name_);
    }

private:
    const Progress& progress_;
    std::size_t all_;
    std::size_t done_ = 0;
    const char* name_;
};

template <class Values> std::string cells(const Values& values, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
        text += ',';
        if (i < values.size()) text += number(static_cast<double>(values[i]));
    }
    return text;
}

std::string framesCsv(const std::vector<FrameRow>& frames, const Progress& progress) {
    Lines lines(progress, frames.size(), "frames");
    std::size_t servos = 0;
    std::size_t levels = 0;
    for (const FrameRow& row : frames) {
        servos = std::max(servos, row.wanted.size());
        levels = std::max(levels, row.levels.size());
    }
    std::ostringstream out;
    out << "time_s,number,animation_s,turned_rad,scene_s" << numbered("level_", levels) << numbered("wanted_", servos)
        << numbered("estimated_", servos)
        << ",device_x_m,device_y_m,device_z_m,eye_x_m,eye_y_m,eye_z_m,viewer,iou,frame_ms,latency_ms\n";
    for (const FrameRow& row : frames) {
        lines.step();
        out << seconds(row.time) << ',' << row.number << ',' << number(row.seconds) << ',' << number(row.turned) << ','
            << number(row.sceneSeconds) << cells(row.levels, levels) << cells(row.wanted, servos)
            << cells(row.estimated, servos);
        for (int axis = 0; axis < 3; ++axis) out << ',' << number(row.worldFromDevice[3][axis]);
        for (int axis = 0; axis < 3; ++axis) out << ',' << (row.eye ? number((*row.eye)[axis]) : std::string());
        out << ',' << csvField(row.viewer) << ',' << number(row.iou) << ',' << number(row.milliseconds) << ','
            << number(row.latency) << '\n';
    }
    return out.str();
}

std::string posesCsv(const std::vector<PoseRow>& poses, const Progress& progress) {
    Lines lines(progress, poses.size(), "poses");
    std::ostringstream out;
    out << "time_s,measured_s,source,name,id,valid,x_m,y_m,z_m,qx,qy,qz,qw\n";
    for (const PoseRow& row : poses) {
        lines.step();
        const auto& [p, q] = row.pose;
        out << seconds(row.time) << ',' << seconds(row.measured) << ',' << csvField(row.source) << ','
            << csvField(row.name) << ',' << row.id << ',' << (row.valid ? 1 : 0);
        for (const double value : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) out << ',' << number(value);
        out << '\n';
    }
    return out.str();
}

std::string eventsCsv(const std::vector<EventRow>& events, const Progress& progress) {
    Lines lines(progress, events.size(), "events");
    std::ostringstream out;
    out << "time_s,kind,text,remedy\n";
    for (const EventRow& row : events) {
        lines.step();
        out << seconds(row.time) << ',' << csvField(row.kind) << ',' << csvField(row.text) << ','
            << csvField(row.remedy) << '\n';
    }
    return out.str();
}

std::string inputsCsv(const std::vector<InputRow>& inputs, const Progress& progress) {
    Lines lines(progress, inputs.size(), "inputs");
    std::ostringstream out;
    out << "time_s,name,value\n";
    for (const InputRow& row : inputs) {
        lines.step();
        out << seconds(row.time) << ',' << csvField(row.name) << ',' << number(row.value) << '\n';
    }
    return out.str();
}

std::string servoCsv(const std::vector<ServoRow>& rows, const Progress& progress) {
    Lines lines(progress, rows.size(), "servo traffic");
    constexpr auto kDigits = "0123456789ABCDEF";
    std::ostringstream out;
    out << "time_s,kind,bytes\n";
    for (const ServoRow& row : rows) {
        lines.step();
        out << seconds(row.time) << ',' << csvField(row.kind) << ',';
        for (const std::uint8_t byte : row.bytes) out << kDigits[byte >> 4] << kDigits[byte & 15];
        out << '\n';
    }
    return out.str();
}

void write(const std::filesystem::path& file, const std::string& text) {
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

} // namespace

void exportCsv(const Recording& recording, const std::filesystem::path& folder, const Progress& progress) {
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (problem) throw DeviceError(folder.string(), problem.message(), "choose a folder that you may write to");
    write(folder / "frames.csv", framesCsv(recording.frames, progress.part(0.0, 0.5)));
    write(folder / "poses.csv", posesCsv(recording.poses, progress.part(0.5, 0.8)));
    write(folder / "events.csv", eventsCsv(recording.events, progress.part(0.8, 0.8)));
    write(folder / "inputs.csv", inputsCsv(recording.inputs, progress.part(0.8, 0.8)));
    write(folder / "servo.csv", servoCsv(recording.servo, progress.part(0.8, 1.0)));
}

} // namespace lumorph
