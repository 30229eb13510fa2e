#include "core/rig/rig_check.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <random>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/rig/rig_check_text.h"
#include "core/rig/state_judge.h"

namespace lumorph {
namespace {

using Kind = RigFinding::Kind;
using Strokes = std::vector<double>;
using Actuators = std::vector<std::size_t>;

constexpr int kFewestStrokes = 33; ///< looked at of one actuator, rest included
constexpr int kMostStrokes = 129;
constexpr int kPairStrokes = 12; ///< looked at along each way of a pair
constexpr int kRaySteps = 32;    ///< between rest and a joint state that is bad
constexpr int kHalvings = 20;
constexpr std::size_t kMostPairs = 4000;
constexpr std::size_t kAllExtremes = 6; ///< actuators whose extremes are all looked at
constexpr std::size_t kMostReduced = 24;

/// Running into something is a matter of which triangles are looked at: whether a part moves along changes its name.
bool alike(Kind a, Kind b) {
    const auto crosses = [](Kind kind) { return kind == Kind::crossing || kind == Kind::collision; };
    return a == b || (crosses(a) && crosses(b));
}

struct Key {
    Kind kind;
    Actuators actuators;
    auto operator<=>(const Key&) const = default;
};

/// A straight way through the joint states.
struct Way {
    Strokes from, to;
    [[nodiscard]] Strokes at(double share) const {
        Strokes strokes(from.size());
        for (std::size_t a = 0; a < strokes.size(); ++a) strokes[a] = std::lerp(from[a], to[a], share);
        return strokes;
    }
};

using FaultsAt = std::function<std::vector<StateFault>(const Strokes&)>;

/// What goes wrong along a way, `steps` equal ones: where it begins, to a millionth of a step, and where it is worst.
class WayWalker {
public:
    WayWalker(const Way& way, int steps, FaultsAt faultsAt)
        : way_(way), steps_(steps), faultsAt_(std::move(faultsAt)) {}

    std::vector<RigFinding> walk(const Progress& progress) {
        for (int step = 0; step <= steps_; ++step) {
            progress.throwIfCancelled();
            look(step);
        }
        std::vector<RigFinding> findings;
        for (auto& [key, track] : tracks_) {
            progress.throwIfCancelled();
            RigFinding finding;
            finding.kind = key.kind;
            finding.actuators = key.actuators;
            finding.first = way_.at(beginning(key, track.firstStep));
            finding.worst = way_.at(share(track.worstStep));
            finding.amount = track.worst.amount;
            finding.place = track.worst.place;
            findings.push_back(std::move(finding));
        }
        return findings;
    }

private:
    struct Track {
        int firstStep = 0;
        int worstStep = 0;
        StateFault worst;
    };

    [[nodiscard]] double share(int step) const { return static_cast<double>(step) / steps_; }

    void look(int step) {
        for (StateFault& fault : faultsAt_(way_.at(share(step)))) {
            const Key key{fault.kind, fault.actuators};
            const auto [at, isNew] = tracks_.try_emplace(key, Track{step, step, fault});
            // Of what crosses, the farther on the deeper.
            const bool crosses = alike(fault.kind, Kind::crossing);
            if (isNew || (!crosses && fault.amount <= at->second.worst.amount)) continue;
            at->second.worstStep = step;
            at->second.worst = std::move(fault);
        }
    }

    [[nodiscard]] bool isBad(const Key& key, double at) const {
        return std::ranges::any_of(faultsAt_(way_.at(at)), [&](const StateFault& fault) {
            return alike(fault.kind, key.kind) && fault.actuators == key.actuators;
        });
    }

    [[nodiscard]] double beginning(const Key& key, int firstStep) const {
        if (firstStep == 0) return 0.0;
        double sound = share(firstStep - 1);
        double bad = share(firstStep);
        for (int k = 0; k < kHalvings; ++k) {
            const double middle = 0.5 * (sound + bad);
            (isBad(key, middle) ? bad : sound) = middle;
        }
        return bad;
    }

    Way way_;
    int steps_;
    FaultsAt faultsAt_;
    std::map<Key, Track> tracks_;
};

void checkOptions(const RigCheckOptions& options) {
    const auto require = [](double value, const char* what) {
        if (!std::isfinite(value) || value < 0.0)
            throw InvalidInput(what, "it is not a number of zero or more", "give a limit such as those by default");
    };
    require(options.maxStretch, "the stretch that the material allows");
    require(options.maxSpeed, "the speed that is allowed");
}

Box reachOf(const Rig& rig, std::size_t actuator) {
    Box box;
    for (const std::uint32_t v : rig.verticesOf(actuator)) box.include(rig.reachOf(v));
    return box;
}

class Checker {
public:
    Checker(const Rig& rig, const RigCheckOptions& options, const Progress& progress)
        : rig_(rig), options_(options), progress_(progress), rest_(rig, options), count_(rig.actuatorCount()) {}

    RigCheck check() {
        for (const StateFault& fault : rest_.faults()) takeRest(fault);
        lookAtEach(progress_.part(0.0, 0.4));
        lookAtPairs(progress_.part(0.4, 0.7));
        lookJointly(progress_.part(0.7, 1.0));
        finish();
        return std::move(check_);
    }

private:
    void takeRest(const StateFault& fault) {
        RigFinding finding;
        finding.kind = fault.kind;
        finding.first = finding.worst = Strokes(count_, 0.0);
        finding.amount = fault.amount;
        finding.place = fault.place;
        take(std::move(finding));
    }

    /// Of faults that cross, one for a set of actuators.
    void take(RigFinding finding) {
        const bool known = std::ranges::any_of(check_.findings, [&](const RigFinding& other) {
            return alike(other.kind, finding.kind) && other.actuators == finding.actuators;
        });
        if (!known) check_.findings.push_back(std::move(finding));
    }

    void takeAll(std::vector<std::vector<RigFinding>>& found) {
        for (auto& some : found) {
            // What begins first comes first, so that of two that cross it is the one that is kept.
            std::ranges::stable_sort(some, {}, [](const RigFinding& f) { return f.first; });
            for (RigFinding& finding : some) take(std::move(finding));
        }
    }

    /// Does work for each of `count` things beside one another, and says how far it is.
    template <class Work>
    void forEach(std::size_t count, const Progress& progress, const char* stage, const Work& work) {
        std::atomic<std::size_t> done{0};
        std::mutex telling;
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
            progress.throwIfCancelled();
            work(k);
            const double share = static_cast<double>(++done) / static_cast<double>(count);
            const std::lock_guard lock(telling);
            progress.report(share, stage);
        });
    }

    void lookAtEach(const Progress& progress) {
        std::vector<std::vector<RigFinding>> found(count_);
        for (const Actuator& actuator : rig_.actuators())
            check_.levelsLookedAt += std::clamp(actuator.levels, kFewestStrokes, kMostStrokes);
        forEach(count_, progress, "each actuator alone, at every level",
                [&](std::size_t a) { found[a] = lookAlone(a, progress); });
        takeAll(found);
    }

    std::vector<RigFinding> lookAlone(std::size_t a, const Progress& progress) const {
        const Actuators own{a};
        StateJudge judge(rest_, own);
        Way way{Strokes(count_, 0.0), Strokes(count_, 0.0)};
        way.to[a] = 1.0;
        const int strokes = std::clamp(rig_.actuators()[a].levels, kFewestStrokes, kMostStrokes);
        WayWalker walker(way, strokes - 1, [&](const Strokes& at) {
            std::vector<StateFault> faults = judge.faultsAt(at);
            StateFault fastest = judge.fastestAt(at, a);
            if (fastest.amount > options_.maxSpeed) faults.push_back(std::move(fastest));
            return faults;
        });
        return walker.walk(progress);
    }

    void lookAtPairs(const Progress& progress) {
        std::vector<Box> reaches;
        for (std::size_t a = 0; a < count_; ++a) reaches.push_back(reachOf(rig_, a));
        std::vector<Actuators> pairs;
        for (std::size_t a = 0; a < count_; ++a)
            for (std::size_t b = a + 1; b < count_ && pairs.size() < kMostPairs; ++b)
                if (meet(reaches[a], reaches[b])) pairs.push_back({a, b});
        check_.pairsLookedAt = static_cast<int>(pairs.size());
        std::vector<std::vector<RigFinding>> found(pairs.size());
        forEach(pairs.size(), progress, "pairs of actuators that can meet",
                [&](std::size_t p) { found[p] = lookAtPair(pairs[p], progress); });
        for (auto& some : found)
            for (RigFinding& finding : some) take(std::move(finding));
    }

    /// Both moved together come first: that way is told of, where there is a fault on several.
    std::vector<RigFinding> lookAtPair(const Actuators& pair, const Progress& progress) const {
        StateJudge judge(rest_, pair);
        const auto state = [&](double first, double second) {
            Strokes strokes(count_, 0.0);
            strokes[pair[0]] = first;
            strokes[pair[1]] = second;
            return strokes;
        };
        std::vector<RigFinding> findings;
        for (const Way& way : {Way{state(0.0, 0.0), state(1.0, 1.0)}, Way{state(1.0, 0.0), state(1.0, 1.0)},
                               Way{state(0.0, 1.0), state(1.0, 1.0)}}) {
            WayWalker walker(way, kPairStrokes, [&](const Strokes& at) {
                std::vector<StateFault> faults = judge.faultsAt(at);
                std::erase_if(faults, [&](const StateFault& fault) { return fault.actuators != pair; });
                return faults;
            });
            for (RigFinding& finding : walker.walk(progress)) findings.push_back(std::move(finding));
        }
        return findings;
    }

    [[nodiscard]] std::vector<Strokes> jointStates() const {
        std::vector<Strokes> states;
        std::mt19937_64 random(options_.seed);
        const bool all = count_ <= kAllExtremes;
        const std::uint64_t extremes = all ? std::uint64_t{1} << count_ : std::uint64_t{1} << kAllExtremes;
        for (std::uint64_t k = 1; k < extremes; ++k) {
            Strokes strokes(count_);
            for (std::size_t a = 0; a < count_; ++a)
                strokes[a] = static_cast<double>(k + 1 == extremes ? 1U : (all ? k >> a : random() >> 63U) & 1U);
            states.push_back(std::move(strokes));
        }
        const int randomStates = std::max(options_.states / 2, options_.states - static_cast<int>(states.size()));
        for (int k = 0; k < randomStates; ++k) {
            Strokes strokes(count_);
            for (double& stroke : strokes) stroke = static_cast<double>(random() >> 11U) * 0x1.0p-53;
            states.push_back(std::move(strokes));
        }
        return states;
    }

    void lookJointly(const Progress& progress) {
        if (count_ < 2) return;
        const std::vector<Strokes> states = jointStates();
        check_.jointStates = static_cast<int>(states.size());
        Actuators all(count_);
        for (std::size_t a = 0; a < count_; ++a) all[a] = a;
        StateJudge first(rest_, all);
        tbb::enumerable_thread_specific<StateJudge> judges(first);
        std::vector<std::vector<StateFault>> faults(states.size());
        forEach(states.size(), progress, "joint states",
                [&](std::size_t s) { faults[s] = judges.local().faultsAt(states[s]); });
        for (std::size_t s = 0; s < states.size(); ++s)
            for (const StateFault& fault : faults[s]) takeJoint(fault, states[s], progress);
    }

    /// The fewest actuators that make a fault of a joint state, and where it begins on the straight way there.
    void takeJoint(const StateFault& fault, const Strokes& state, const Progress& progress) {
        if (!seen_.insert({fault.kind, fault.actuators}).second) return;
        progress.throwIfCancelled();
        progress.report(1.0, "who makes what was found");
        const Actuators fewest = reduced(fault, state, progress);
        if (fewest.empty()) return;
        if (fewest != fault.actuators && !seen_.insert({fault.kind, fewest}).second) return;
        StateJudge judge(rest_, fewest);
        WayWalker walker({Strokes(count_, 0.0), only(fewest, state)}, kRaySteps, [&](const Strokes& at) {
            std::vector<StateFault> faults = judge.faultsAt(at);
            std::erase_if(faults, [&](const StateFault& one) { return one.actuators != fewest; });
            return faults;
        });
        for (RigFinding& finding : walker.walk(progress))
            if (alike(finding.kind, fault.kind)) take(std::move(finding));
    }

    [[nodiscard]] Strokes only(const Actuators& actuators, const Strokes& state) const {
        Strokes strokes(count_, 0.0);
        for (const std::size_t a : actuators) strokes[a] = state[a];
        return strokes;
    }

    /// Without an actuator that can be left out the fault is still there. Empty when it needs others, that the fault's
    /// own triangles do not know of.
    [[nodiscard]] Actuators reduced(const StateFault& fault, const Strokes& state, const Progress& progress) const {
        StateJudge judge(rest_, fault.actuators);
        const auto makes = [&](const Actuators& actuators) {
            return std::ranges::any_of(judge.faultsAt(only(actuators, state)), [&](const StateFault& one) {
                return alike(one.kind, fault.kind) && one.actuators == actuators;
            });
        };
        if (fault.actuators.size() > kMostReduced) return makes(fault.actuators) ? fault.actuators : Actuators();
        Actuators left = fault.actuators;
        for (const std::size_t a : fault.actuators) {
            progress.throwIfCancelled();
            Actuators fewer = left;
            std::erase(fewer, a);
            if (!fewer.empty() && makes(fewer)) left = std::move(fewer);
        }
        return makes(left) ? left : Actuators();
    }

    void finish() {
        for (RigFinding& finding : check_.findings) {
            finding.limit = finding.kind == Kind::stretch ? options_.maxStretch
                            : finding.kind == Kind::speed ? options_.maxSpeed
                                                          : 0.0;
            finding.sentence = sentenceOf(rig_, finding);
            finding.remedy = remedyOf(rig_, finding);
        }
        // Crossing and running into something are as grave as one another.
        const auto gravity = [](Kind kind) { return kind == Kind::collision ? Kind::crossing : kind; };
        std::ranges::stable_sort(check_.findings, [&](const RigFinding& a, const RigFinding& b) {
            if (gravity(a.kind) != gravity(b.kind)) return gravity(a.kind) < gravity(b.kind);
            if (a.actuators.empty() != b.actuators.empty()) return a.actuators.empty();
            return a.amount > b.amount;
        });
    }

    const Rig& rig_;
    const RigCheckOptions& options_;
    const Progress& progress_;
    RestShape rest_;
    std::size_t count_;
    RigCheck check_;
    std::set<Key> seen_; ///< what joint states showed that was looked into
};

} // namespace

RigCheck checkRig(const Rig& rig, const RigCheckOptions& options, const Progress& progress) {
    checkOptions(options);
    progress.throwIfCancelled();
    progress.report(0.0, "looking at the rig at rest");
    return Checker(rig, options, progress).check();
}

} // namespace lumorph
