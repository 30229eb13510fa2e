#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <QObject>

#include "app/studio/document/job_slots.h"
#include "core/rig/rig.h"
#include "core/search/rig_search.h"

namespace lumorph::studio {

/// Where its jobs and notices are told.
inline constexpr const char* kSuggestPlace = "rig.suggest";

/// What a search for bend lines is asked.
struct SuggestChoice {
    std::vector<std::filesystem::path> targets;
    SearchCost cost = SearchCost::servos;
    std::size_t most = 8; ///< servos
    bool operator==(const SuggestChoice&) const = default;
};

/// A design that a search has found.
struct Candidate {
    ScoredDesign design;
    std::vector<Flap> flaps;
    double price = 0.0;       ///< of its servos, euros
    std::vector<double> fits; ///< IoU, in the targets' order
};

/// What a search has found so far.
struct Suggestions {
    std::vector<glm::dvec2> outline;  ///< of the sheet, metres
    std::vector<std::string> targets; ///< names
    std::vector<Candidate> front;     ///< no design is both cheaper and better; the cheapest first
    std::optional<DesignScore> start; ///< of the rig that was open; none where its sheet has no bend line yet
    int generation = 0;
    std::uint64_t evaluations = 0;
};

/// The search for bend lines beside the window: goes on generation after generation until it is stopped, and then from
/// there. There is one at a time; it leaves a core to the window and the loop.
class SuggestSearch : public QObject {
    Q_OBJECT
public:
    SuggestSearch(Jobs& jobs, Notices& notices, QObject* parent = nullptr);

    /// Begins anew. `origin` is the rig as it was opened, which tells it from others (StudioState::RigAsset).
    void start(std::shared_ptr<const Rig> rig, std::shared_ptr<const Rig> origin, const SuggestChoice& choice);
    void goOn();
    void stop(); ///< what was found stays
    void clear();

    [[nodiscard]] bool running() const noexcept { return running_; }
    [[nodiscard]] bool empty() const noexcept { return shared_ == nullptr; }
    /// What the running or stopped search was asked.
    [[nodiscard]] const SuggestChoice& choice() const noexcept { return choice_; }
    /// Null until its first designs were looked at.
    [[nodiscard]] std::shared_ptr<const Suggestions> found() const;
    /// What it does before that.
    [[nodiscard]] const QString& stage() const noexcept { return stage_; }

    /// Builds a design's rig in a job; the search stops. A design whose solid is not sound gives way to the next one of
    /// the same cost, and where there is none a notice says so.
    void build(const Candidate& candidate, std::function<void(std::shared_ptr<const Rig>)> done);
    /// Whether a rig is the one that is searched for, or was built by it.
    [[nodiscard]] bool knows(const std::shared_ptr<const Rig>& origin) const;
    /// How the search sees such a rig.
    [[nodiscard]] std::optional<DesignScore> scoreOf(const std::shared_ptr<const Rig>& origin) const;

signals:
    void changed(); ///< begun, gone on, ended, cleared; and while it runs

private:
    struct Bench;
    struct Shared;
    class Watch;
    struct Built;
    void run();
    static void work(Shared& shared, const Progress& progress);

    Jobs& jobs_;
    JobSlots slots_;
    std::shared_ptr<std::mutex> turn_ = std::make_shared<std::mutex>();
    std::shared_ptr<Shared> shared_;
    SuggestChoice choice_;
    Jobs::Id job_ = 0;
    QString stage_;
    bool running_ = false;
    std::shared_ptr<const Rig> origin_;
    std::vector<std::pair<std::shared_ptr<const Rig>, DesignScore>> built_;
};

} // namespace lumorph::studio
