#include "app/studio/shell/application_turn.h"

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

namespace lumorph::studio {

namespace fs = std::filesystem;

ApplicationTurn::ApplicationTurn(std::span<const Demo> all, Told told, const Clock& clock)
    : all_(all), told_(std::move(told)), clock_(clock) {}

const Demo* ApplicationTurn::after(const std::string& name) const {
    std::vector<const Demo*> turn;
    for (const Demo& demo : all_)
        if (demo.program) turn.push_back(&demo);
    const auto found = std::ranges::find(turn, name, [](const Demo* demo) { return demo->name; });
    if (found != turn.end()) std::ranges::rotate(turn, std::next(found));
    const auto next = std::ranges::find_if(turn, [this](const Demo* demo) { return !leavesOut(*demo); });
    return next == turn.end() ? nullptr : *next;
}

bool ApplicationTurn::leavesOut(const Demo& demo) const {
    const auto failure = failures_.find(demo.name);
    return failure != failures_.end() && clock_.now() < failure->second.until && caseOf(demo) == failure->second.in;
}

void ApplicationTurn::failed(const Demo& demo) { failures_[demo.name] = {caseOf(demo), clock_.now() + kLeftOut}; }

void ApplicationTurn::shown(const Demo& demo) { failures_.erase(demo.name); }

ApplicationTurn::FileState ApplicationTurn::stateOf(const fs::path& file) {
    FileState state;
    std::error_code failed;
    state.exists = fs::exists(file, failed);
    if (!state.exists) return state;
    state.written = fs::last_write_time(file, failed);
    if (failed) state.written = {};
    if (fs::is_regular_file(file, failed)) state.size = fs::file_size(file, failed);
    if (failed) state.size = 0;
    return state;
}

ApplicationTurn::Case ApplicationTurn::caseOf(const Demo& demo) const {
    Case now;
    if (!told_) return now;
    now.told = told_(demo);
    for (const DemoOption& option : demo.options) {
        const auto told = now.told.find(option.name);
        if (option.file && told != now.told.end()) now.files.push_back(stateOf(told->second));
    }
    return now;
}

} // namespace lumorph::studio
