#include "core/motion/pose_book.h"

#include <algorithm>
#include <optional>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

constexpr std::size_t kMostActuators = 4096; // of all rigs that a project has had

std::optional<std::size_t> placeOf(std::span<const std::string> names, std::string_view name) {
    const auto at = std::ranges::find(names, name);
    if (at == names.end()) return std::nullopt;
    return static_cast<std::size_t>(at - names.begin());
}

/// The book knows these actuators, too; in all poses they rest.
void learn(PoseBook& book, std::span<const std::string> actuators) {
    for (const std::string& name : actuators)
        if (!placeOf(book.actuators, name)) book.actuators.push_back(name);
    for (NamedPose& pose : book.sequence.poses) pose.strokes.resize(book.actuators.size(), 0.0);
}

} // namespace

void requireSound(const PoseBook& book) {
    if (book.actuators.size() > kMostActuators)
        throw InvalidInput("the poses", "they are of more than " + std::to_string(kMostActuators) + " actuators",
                           "remove some");
    std::set<std::string_view> names;
    for (const std::string& name : book.actuators) {
        if (name.empty()) throw InvalidInput("the poses", "one of their actuators has no name", "name it");
        if (!names.insert(name).second)
            throw InvalidInput("the poses", "two of their actuators are called " + inQuotes(name),
                               "rename one of them");
    }
    requireSound(book.sequence, book.actuators.size());
}

PoseSequence sequenceFor(const PoseBook& book, std::span<const std::string> actuators) {
    PoseSequence sequence = book.sequence;
    for (NamedPose& pose : sequence.poses) {
        std::vector<double> strokes;
        for (const std::string& name : actuators) {
            const auto place = placeOf(book.actuators, name);
            strokes.push_back(place ? pose.strokes[*place] : 0.0);
        }
        pose.strokes = std::move(strokes);
    }
    return sequence;
}

PoseFit fitOf(const PoseBook& book, std::span<const std::string> actuators) {
    PoseFit fit;
    if (book.sequence.poses.empty()) return fit;
    for (const std::string& name : actuators)
        if (!placeOf(book.actuators, name)) fit.atRest.push_back(name);
    for (const std::string& name : book.actuators)
        if (!placeOf(actuators, name)) fit.kept.push_back(name);
    return fit;
}

std::string freePoseName(const PoseBook& book, const std::string& wish) {
    std::string name = wish;
    for (int k = 2; std::ranges::find(book.sequence.poses, name, &NamedPose::name) != book.sequence.poses.end(); ++k)
        name = wish + " " + std::to_string(k);
    return name;
}

void keepPose(PoseBook& book, const std::string& name, std::span<const std::string> actuators,
              std::span<const double> strokes) {
    // What no pose speaks of is forgotten with the last of them.
    if (book.sequence.poses.empty()) book.actuators.clear();
    learn(book, actuators);
    auto at = std::ranges::find(book.sequence.poses, name, &NamedPose::name);
    if (at == book.sequence.poses.end())
        at = book.sequence.poses.insert(at, {name, std::vector<double>(book.actuators.size(), 0.0)});
    for (std::size_t k = 0; k < std::min(actuators.size(), strokes.size()); ++k)
        at->strokes[*placeOf(book.actuators, actuators[k])] = strokes[k];
}

void renamePose(PoseBook& book, std::string_view name, const std::string& to) {
    PoseBook renamed = book;
    for (NamedPose& pose : renamed.sequence.poses)
        if (pose.name == name) pose.name = to;
    for (PoseStep& step : renamed.sequence.steps)
        if (step.pose == name) step.pose = to;
    requireSound(renamed);
    book = std::move(renamed);
}

void removePose(PoseBook& book, std::string_view name) {
    std::erase_if(book.sequence.steps, [&](const PoseStep& step) { return step.pose == name; });
    std::erase_if(book.sequence.poses, [&](const NamedPose& pose) { return pose.name == name; });
}

void followRenames(PoseBook& book, std::span<const std::string> before, std::span<const std::string> after) {
    if (before.size() != after.size()) return;
    for (std::size_t k = 0; k < before.size(); ++k) {
        // A name that stands elsewhere tells of another order.
        if (before[k] == after[k] || placeOf(after, before[k]) || placeOf(before, after[k])) continue;
        const auto place = placeOf(book.actuators, before[k]);
        if (place && !placeOf(book.actuators, after[k])) book.actuators[*place] = after[k];
    }
}

} // namespace lumorph
