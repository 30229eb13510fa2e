#include "core/rig/parts/build_files.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <span>
#include <system_error>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/mesh_writers.h"
#include "core/rig/parts/plan_making.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStyle = R"(<style>
body { font: 16px/1.5 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; width: 100%; } td, th { border-bottom: 1px solid #ccc; padding: .3em .6em; text-align: left; }
svg { width: 100%; max-height: 26em; background: #fafafa; border: 1px solid #ddd; }
td svg { width: 9em; height: 6em; }
text { font: 5px sans-serif; text-anchor: middle; fill: #000; }
path { stroke: #333; stroke-width: .3; }
.wall { fill: #9aa7b1; } .floor { fill: #e9edf0; } .seat { fill: #f3c98b; } .servo { fill: #5b8dd9; fill-opacity: .6; }
.lever { fill: #d9665b; fill-opacity: .7; } .board { fill: #6fae7a; } .screw { fill: #777; }
.layer1 { fill: #8d99a3; } .layer2 { fill: #b5c0c8; } .layer3 { fill: #d3dbe0; } .layer4 { fill: #eef2f4; }
.note { background: #fff6dd; padding: .4em .8em; } @media print { body { margin: 0; } h2 { break-after: avoid; } }
</style>
)";

std::string fixed(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string sizeOf(const PrintPart& part) {
    const glm::vec3 size = boundingBox(part.solid.mesh.positions).size();
    return fixed(size.x, 1) + " x " + fixed(size.y, 1) + " x " + fixed(size.z, 1);
}

double cubicCentimetres(const PrintPart& part) { return 1e-3 * signedVolume(part.solid.mesh); }

std::string partsTable(const BuildPlan& plan) {
    std::string text = "part,count,printed or bought,file,material,size (mm),volume (cm3),use\n";
    for (const PrintPart& part : plan.parts)
        text += csvField(part.name) + "," + std::to_string(part.count) + ",printed," + csvField(part.name + ".stl") +
                "," + csvField(part.material) + "," + csvField(sizeOf(part)) + "," + fixed(cubicCentimetres(part), 2) +
                "," + csvField(part.use) + "\n";
    for (const BoughtPart& part : plan.bought)
        text += csvField(part.name) + "," + std::to_string(part.count) + ",bought,,,,," + csvField(part.use) + "\n";
    return text;
}

std::string channelText(int channel) { return channel < 0 ? "" : std::to_string(channel); }

// Whole microseconds within the limits, as the sketch has them.
std::string leastPulse(const WiringRow& row) { return fixed(std::ceil(row.pulseMin), 0); }
std::string greatestPulse(const WiringRow& row) { return fixed(std::floor(row.pulseMax), 0); }
std::string restPulse(const WiringRow& row) { return row.reversed ? greatestPulse(row) : leastPulse(row); }
std::string endPulse(const WiringRow& row) { return row.reversed ? leastPulse(row) : greatestPulse(row); }

std::string wiringTable(const BuildPlan& plan) {
    std::string text = "actuator,channel,pin,pulse at rest (us),pulse at the end (us),least pulse (us),greatest pulse "
                       "(us),reversed,seat,lever at rest (deg),lever at the end (deg)\n";
    for (const WiringRow& row : plan.wiring)
        text += csvField(row.actuator) + "," + channelText(row.channel) + "," + channelText(row.pin) + "," +
                restPulse(row) + "," + endPulse(row) + "," + leastPulse(row) + "," + greatestPulse(row) + "," +
                (row.reversed ? "yes" : "no") + "," + csvField(row.seat) + "," +
                (row.lever ? fixed(row.lever->rest.inDegrees(), 1) : "") + "," +
                (row.lever ? fixed(row.lever->end.inDegrees(), 1) : "") + "\n";
    return text;
}

std::string cells(const std::vector<std::string>& values, const char* kind) {
    std::string row = "<tr>";
    for (const std::string& value : values) row += std::string("<") + kind + ">" + value + "</" + kind + ">";
    return row + "</tr>\n";
}

std::string partsOnPage(const BuildPlan& plan) {
    std::string html =
        "<h2>Parts to print</h2>\n<table>" + cells({"", "part", "count", "size in mm", "material", "use"}, "th");
    for (const PrintPart& part : plan.parts)
        html += cells({pictureOf(part.solid), escaped(part.name), std::to_string(part.count), sizeOf(part),
                       escaped(part.material), escaped(part.use)},
                      "td");
    html += "</table>\n";
    if (plan.bought.empty()) return html;
    html += "<h2>Parts to buy</h2>\n<table>" + cells({"part", "count", "use"}, "th");
    for (const BoughtPart& part : plan.bought)
        html += cells({escaped(part.name), std::to_string(part.count), escaped(part.use)}, "td");
    return html + "</table>\n";
}

std::string wiringOnPage(const BuildPlan& plan) {
    if (plan.wiring.empty()) return {};
    std::string html = "<h2>Wiring</h2>\n<table>" +
                       cells({"actuator", "pin", "pulse at rest", "pulse at the end", "reversed", "seat"}, "th");
    constexpr std::size_t kMost = 100;
    for (std::size_t k = 0; k < std::min(kMost, plan.wiring.size()); ++k) {
        const WiringRow& row = plan.wiring[k];
        html += cells({escaped(row.actuator), channelText(row.pin), restPulse(row), endPulse(row),
                       row.reversed ? "yes" : "no", escaped(row.seat)},
                      "td");
    }
    html += "</table>\n";
    if (plan.wiring.size() > kMost)
        html += "<p>... and " + std::to_string(plan.wiring.size() - kMost) + " more in wiring.csv.</p>\n";
    return html;
}

std::string stepsOnPage(const BuildPlan& plan) {
    std::string html = "<h2>Assembly</h2>\n";
    int number = 0;
    for (const BuildStep& step : plan.steps) {
        html += "<h3>" + std::to_string(++number) + ". " + escaped(step.title) + "</h3>\n<p>";
        for (const char c : escaped(step.text)) html += c == '\n' ? std::string("<br>\n") : std::string(1, c);
        html += "</p>\n" + step.picture;
    }
    return html;
}

std::string assemblyPage(const BuildPlan& plan) {
    const std::string title = "Building: " + escaped(plan.device);
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + title +
                       "</title>\n" + kStyle + "</head><body>\n<h1>" + title + "</h1>\n";
    for (const std::string& note : plan.notes) html += "<p class=\"note\">" + escaped(note) + "</p>\n";
    return html + partsOnPage(plan) + wiringOnPage(plan) + stepsOnPage(plan) + "</body></html>\n";
}

/// At its real size.
std::string sheetDrawing(const BuildPlan& plan) {
    PlanPicture picture;
    picture.add(plan.sheet, "sheet");
    std::string svg = picture.svg();
    const std::size_t box = svg.find("viewBox=\"") + 9;
    double x = 0.0;
    double y = 0.0;
    double width = 0.0;
    double height = 0.0;
    std::sscanf(svg.c_str() + box, "%lf %lf %lf %lf", &x, &y, &width, &height);
    const std::string head = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + fixed(width, 2) + "mm\" height=\"" +
                             fixed(height, 2) + "mm\" ";
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + head + svg.substr(5);
}

std::vector<std::byte> bytesOf(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

/// Removes the folder unless it is told that all went well.
class DraftFolder {
public:
    explicit DraftFolder(const fs::path& wanted) {
        std::error_code error;
        for (int k = 1; k == 1 || fs::exists(fs::symlink_status(path_, error)); ++k)
            path_ = wanted.string() + ".part" + std::to_string(k);
        if (!fs::create_directory(path_, error)) throwWriteError(wanted, error ? error.value() : EEXIST);
    }
    DraftFolder(const DraftFolder&) = delete;
    DraftFolder& operator=(const DraftFolder&) = delete;
    ~DraftFolder() {
        std::error_code ignored;
        if (!done_) fs::remove_all(path_, ignored);
    }
    [[nodiscard]] const fs::path& path() const noexcept { return path_; }
    void becomes(const fs::path& wanted) {
        std::error_code error;
        fs::rename(path_, wanted, error); // takes the place of an empty folder
        if (error) throwWriteError(wanted, error.value());
        done_ = true;
    }

private:
    fs::path path_;
    bool done_ = false;
};

} // namespace

std::map<std::string, std::vector<std::byte>> buildFiles(const BuildPlan& plan) {
    std::map<std::string, std::vector<std::byte>> files;
    for (const PrintPart& part : plan.parts) {
        files[part.name + ".stl"] = writeStl(part.solid.mesh);
        files[part.name + ".3mf"] = write3mf(part.solid.mesh, part.name);
    }
    files["parts.csv"] = bytesOf(partsTable(plan));
    if (!plan.wiring.empty()) files["wiring.csv"] = bytesOf(wiringTable(plan));
    if (!plan.sheet.empty()) files["sheet.svg"] = bytesOf(sheetDrawing(plan));
    files["assembly.html"] = bytesOf(assemblyPage(plan));
    return files;
}

void writeBuildFolder(const std::map<std::string, std::vector<std::byte>>& files, const fs::path& folder,
                      const std::function<void(const fs::path&)>& more, const Progress& progress) {
    const fs::path wanted = folder.has_filename() ? folder : folder.parent_path();
    std::error_code error;
    if (fs::exists(fs::symlink_status(wanted, error)) &&
        !(fs::is_directory(wanted, error) && fs::is_empty(wanted, error)))
        throw InvalidInput(wanted.string(), "there is something of that name already", "name a new or an empty folder");
    DraftFolder draft(wanted);
    for (const auto& [name, bytes] : files) {
        progress.throwIfCancelled();
        writeFileAtomically(draft.path() / name, bytes);
    }
    if (more) more(draft.path());
    progress.throwIfCancelled();
    draft.becomes(wanted);
}

} // namespace lumorph
