#include "app/workspaces/rig/suggest_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/spare_core.h"
#include "core/mdf/target_library.h"
#include "core/search/search_front.h"

namespace lumorph::studio {

namespace {

constexpr const char* kSearch = "search";
constexpr const char* kBuild = "build";
constexpr int kPopulation = 64;
constexpr std::uint64_t kSeed = 1;
constexpr double kUnknownEnd = -1.0; ///< it goes on until it is stopped

std::int64_t keyOf(double cost) { return std::llround(100.0 * cost); }

} // namespace

/// What stays the same from the first generation to the last.
struct SuggestSearch::Bench {
    Bench(const Rig& rig, const SheetDevice& sheet, SearchTargets placed, const SuggestChoice& choice,
          const Progress& progress)
        : start(sheet), oneSheet(rig.parts().sheet.has_value()), targets(std::move(placed)), cost(choice.cost),
          designs(sheet, choice.most), fit(designs.sheet(), designs.angle(), targets.targets, {}, progress),
          scorer(designs, fit, choice.cost) {}
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    static std::shared_ptr<const Bench> of(const Rig& rig, const SuggestChoice& choice, const Progress& progress);
    /// How the rig itself would be judged; it may have more lines than a design may. None where the search would see
    /// another device: flaps of a design do not overlap, and are cut where a rig may have one continuous sheet.
    [[nodiscard]] std::optional<DesignScore> startScore() const;
    [[nodiscard]] Candidate candidateOf(const ScoredDesign& design) const;

    SheetDevice start;
    bool oneSheet;
    SearchTargets targets;
    SearchCost cost;
    SheetDesigns designs;
    SheetFit fit;
    DesignScorer scorer;
};

std::shared_ptr<const SuggestSearch::Bench> SuggestSearch::Bench::of(const Rig& rig, const SuggestChoice& choice,
                                                                     const Progress& progress) {
    const SheetDevice sheet = sheetDeviceOf(rig);
    std::vector<LibraryTarget> library = readTargets(choice.targets, progress.part(0.0, 0.6));
    progress.report(0.6, "placing the shapes");
    SearchTargets placed = placeForSearch(rig, sheet, std::move(library), TargetPlacing::automatic, progress);
    progress.report(0.8, "turning the shapes into voxels");
    return std::make_shared<const Bench>(rig, sheet, std::move(placed), choice, progress.part(0.8, 1.0));
}

std::optional<DesignScore> SuggestSearch::Bench::startScore() const {
    if (start.bends.empty() || oneSheet) return std::nullopt;
    const SheetDesigns roomy(start, start.bends.size());
    const DesignPoint point = roomy.pointOf(start);
    if (roomy.flapsOf(point).size() < start.bends.size()) return std::nullopt;
    return DesignScorer(roomy, fit, cost).of(point);
}

Candidate SuggestSearch::Bench::candidateOf(const ScoredDesign& design) const {
    Candidate candidate{design, designs.flapsOf(design.point), 0.0, {}};
    candidate.price = scorer.priceOf(candidate.flaps);
    candidate.fits = fit.each(candidate.flaps);
    return candidate;
}

/// What the window and the job of a search both know.
struct SuggestSearch::Shared {
    std::shared_ptr<const Rig> rig;
    SuggestChoice choice;
    std::shared_ptr<std::mutex> turn; ///< of the one job that may search

    std::mutex mutex; ///< of what follows
    std::shared_ptr<const Bench> bench;
    std::optional<SearchState> state; ///< after the last whole generation
    std::shared_ptr<const Suggestions> found;
};

/// Sees every design that is looked at, so that the front is there from the first second.
class SuggestSearch::Watch {
public:
    Watch(Shared& shared, const Bench& bench, const std::optional<SearchState>& state)
        : shared_(shared), bench_(bench) {
        for (const LibraryTarget& target : bench.targets.library) now_.targets.push_back(target.name);
        now_.outline = bench.designs.sheet().outline;
        now_.start = bench.startScore();
        if (!state) return;
        best_.best = state->best;
        now_.generation = state->generation;
        now_.evaluations = state->evaluations;
    }

    void look(const std::vector<DesignPoint>& points, const std::vector<DesignScore>& scores) {
        now_.evaluations += points.size();
        for (std::size_t k = 0; k < points.size(); ++k) {
            if (!(scores[k].cost > 0.0)) continue;
            std::vector<ScoredDesign>& kept = best_.best[keyOf(scores[k].cost)];
            if (kept.empty() || scores[k].fit > kept.front().score.fit) kept = {{points[k], scores[k]}};
        }
        show();
    }
    void setGeneration(int generation) {
        now_.generation = generation;
        show();
    }
    void show() {
        std::vector<Candidate> front;
        for (const ScoredDesign& design : frontOf(best_)) {
            if (!(design.score.cost > 0.0)) continue;
            const auto known =
                std::ranges::find_if(now_.front, [&](const Candidate& c) { return c.design.point == design.point; });
            front.push_back(known != now_.front.end() ? *known : bench_.candidateOf(design));
        }
        now_.front = std::move(front);
        auto shown = std::make_shared<const Suggestions>(now_);
        const std::scoped_lock lock(shared_.mutex);
        shared_.found = std::move(shown);
    }

private:
    Shared& shared_;
    const Bench& bench_;
    SearchState best_; ///< its best designs alone
    Suggestions now_;
};

/// What building a design gives.
struct SuggestSearch::Built {
    std::shared_ptr<const Rig> rig;
};

SuggestSearch::SuggestSearch(Jobs& jobs, Notices& notices, QObject* parent)
    : QObject(parent), jobs_(jobs), slots_(*this, jobs, notices) {
    connect(&jobs_, &Jobs::progressed, this, [this](int id) {
        if (id != job_ || !running_) return;
        for (const Jobs::Status& status : jobs_.running())
            if (status.id == id) stage_ = status.stage;
        emit changed();
    });
    connect(&jobs_, &Jobs::finished, this, [this](int id) {
        if (id != job_ || !running_) return;
        running_ = false;
        emit changed();
    });
}

void SuggestSearch::start(std::shared_ptr<const Rig> rig, std::shared_ptr<const Rig> origin,
                          const SuggestChoice& choice) {
    stop();
    shared_ = std::make_shared<Shared>();
    shared_->rig = std::move(rig);
    shared_->choice = choice;
    shared_->turn = turn_;
    choice_ = choice;
    origin_ = std::move(origin);
    built_.clear();
    run();
}

void SuggestSearch::goOn() {
    if (shared_ && !running_) run();
}

void SuggestSearch::run() {
    stage_.clear();
    running_ = true;
    slots_.run<bool>(
        kSearch, kSuggestPlace, tr("Searching for bend lines"),
        [shared = shared_](const Progress& progress) {
            const std::scoped_lock turn(*shared->turn); // the job before may still be on its way out
            leavingACore([&] { work(*shared, progress); });
            return true;
        },
        [](bool) {});
    for (const Jobs::Status& status : jobs_.running())
        if (status.place == kSuggestPlace) job_ = status.id;
    emit changed();
}

void SuggestSearch::work(Shared& shared, const Progress& progress) {
    progress.throwIfCancelled();
    std::shared_ptr<const Bench> bench;
    std::optional<SearchState> state;
    {
        const std::scoped_lock lock(shared.mutex);
        bench = shared.bench;
        state = shared.state;
    }
    if (!bench) {
        bench = Bench::of(*shared.rig, shared.choice, progress);
        const std::scoped_lock lock(shared.mutex);
        shared.bench = bench;
    }
    Watch watch(shared, *bench, state);
    const ScoreBatch score = [&](const std::vector<DesignPoint>& points) {
        std::vector<DesignScore> scores = bench->scorer.batch(points, progress);
        watch.look(points, scores);
        progress.report(kUnknownEnd, "looking at designs");
        return scores;
    };
    if (!state) state = beginSearch(bench->designs, kPopulation, kSeed, {bench->designs.pointOf(bench->start)}, score);
    while (true) {
        {
            const std::scoped_lock lock(shared.mutex);
            shared.state = state;
        }
        progress.throwIfCancelled();
        nextGeneration(*state, score);
        watch.setGeneration(state->generation);
        progress.report(kUnknownEnd, "generation " + std::to_string(state->generation));
    }
}

void SuggestSearch::stop() {
    if (!running_) return;
    slots_.stop(kSearch); // `finished` tells the rest
}

void SuggestSearch::clear() {
    stop();
    slots_.stop(kBuild);
    shared_.reset();
    origin_.reset();
    built_.clear();
    emit changed();
}

std::shared_ptr<const Suggestions> SuggestSearch::found() const {
    if (!shared_) return nullptr;
    const std::scoped_lock lock(shared_->mutex);
    return shared_->found;
}

void SuggestSearch::build(const Candidate& candidate, std::function<void(std::shared_ptr<const Rig>)> done) {
    stop();
    const auto work = [shared = shared_, design = candidate.design](const Progress& progress) {
        const std::scoped_lock turn(*shared->turn);
        std::shared_ptr<const Bench> bench;
        std::vector<ScoredDesign> alike;
        {
            const std::scoped_lock lock(shared->mutex);
            bench = shared->bench;
            if (shared->state)
                if (const auto kept = shared->state->best.find(keyOf(design.score.cost));
                    kept != shared->state->best.end())
                    alike = kept->second;
        }
        for (const std::vector<ScoredDesign>& tried : {std::vector<ScoredDesign>{design}, alike}) {
            SearchState one;
            if (!tried.empty()) one.best[1] = tried;
            std::vector<FrontDesign> front =
                buildFront(bench->designs, bench->scorer, bench->cost, one, bench->targets, progress);
            if (!front.empty()) return Built{std::make_shared<const Rig>(std::move(front.front().rig))};
        }
        throw InvalidInput("This design", "its solid would not be sound", "choose another dot, or search on");
    };
    slots_.run<Built>(kBuild, QString(kSuggestPlace) + ".build", tr("Building the device"), work,
                      [this, score = candidate.design.score, done = std::move(done)](const Built& built) {
                          built_.emplace_back(built.rig, score);
                          done(built.rig);
                      });
}

bool SuggestSearch::knows(const std::shared_ptr<const Rig>& origin) const {
    return origin &&
           (origin == origin_ || std::ranges::any_of(built_, [&](const auto& b) { return b.first == origin; }));
}

std::optional<DesignScore> SuggestSearch::scoreOf(const std::shared_ptr<const Rig>& origin) const {
    for (const auto& [rig, score] : built_)
        if (rig == origin) return score;
    const auto now = found();
    return now && origin && origin == origin_ ? now->start : std::nullopt;
}

} // namespace lumorph::studio
