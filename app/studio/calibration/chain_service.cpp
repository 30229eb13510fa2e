#include "app/studio/calibration/chain_service.h"

#include <utility>

#include <QObject>

#include "app/studio/calibration/chain_live.h"
#include "app/studio/calibration/table_bench.h"
#include "calibration/stages/lab_bench.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr auto kChainPlace = "chain"; // of jobs and notices
constexpr auto kKeepPlace = "chain.keep";

QString wordsOfError(const std::exception& error) {
    const Notice notice = noticeOf(error);
    QString words = notice.subject.isEmpty() ? notice.why : notice.subject + ": " + notice.why;
    if (!notice.remedy.isEmpty()) words += ". " + notice.remedy.left(1).toUpper() + notice.remedy.mid(1) + '.';
    return words;
}

/// The step with which a link is measured, by where it is measured.
ChainStep measuringStep(const ChainState& state, ChainStep::Tone tone, const QString& title, const QString& text,
                        const QString& inLab) {
    using What = ChainStep::Do;
    const ChainLink& link = chainLinks()[state.chosen];
    if (link.stage->hasSequence()) return {What::sequence, tone, title, text, QObject::tr("Open it")};
    const LinkWay way = wayOf(state, state.chosen);
    if (way == LinkWay::lab) return {What::measure, tone, title, text, inLab};
    if (way == LinkWay::live && !link.notConnected.isEmpty())
        return {What::nothing, ChainStep::Tone::warning, title, link.notConnected, QString()};
    if (way == LinkWay::live)
        return {What::measure, tone, title, text,
                link.isWithTracker() ? QObject::tr("Begin, with the tracker")
                : link.isMoved       ? QObject::tr("Begin, hands off")
                                     : QObject::tr("Begin, with the camera")};
    if (const auto missing = missingFile(state, state.chosen))
        return {What::chooseFile, tone, title, text,
                *missing < link.files.size() ? QObject::tr("Choose: %1").arg(link.files[*missing].title)
                                             : QObject::tr("Choose a recording")};
    const bool isOurs = !state.files.at(state.chosen).back().empty();
    return {What::measure, tone, title, text,
            isOurs ? QObject::tr("Solve the recording") : QObject::tr("Read the recordings")};
}

} // namespace

LinkWay wayOf(const ChainState& state, std::size_t link) {
    return chainLinks()[link].stage->hasSequence() ? LinkWay::lab : state.way;
}

std::optional<std::size_t> missingFile(const ChainState& state, std::size_t link) {
    const std::size_t count = chainLinks()[link].files.size();
    const auto chosen = state.files.find(link);
    const bool isAny = chosen != state.files.end();
    if (isAny && !chosen->second[count].empty()) return std::nullopt;
    for (std::size_t k = 0; k < count; ++k)
        if (!isAny || chosen->second[k].empty()) return k;
    return count > 0 ? std::nullopt : std::optional(count);
}

namespace {

ChainStep ownStepOf(const ChainState& state) {
    using What = ChainStep::Do;
    const ChainLink& link = chainLinks()[state.chosen];
    const CalibrationSession& session = state.session;
    const StageStand& stand = session.stands()[state.chosen];
    const std::optional<std::size_t> running = session.running();
    if (state.live && running == state.chosen)
        return {What::cancel, state.live->trouble.isEmpty() ? StepTone::live : StepTone::warning, state.live->title,
                state.live->trouble.isEmpty() ? QObject::tr("Step %1 of %2; each is noticed by itself.")
                                                    .arg(state.live->step + 1)
                                                    .arg(state.live->steps)
                                              : state.live->trouble,
                QObject::tr("Cancel")};
    if (running == state.chosen)
        return {What::cancel, StepTone::live, QObject::tr("Measuring: %1").arg(link.title), state.stage,
                QObject::tr("Cancel")};
    if (running)
        return {What::cancel, StepTone::live, QObject::tr("Measuring: %1").arg(chainLinks()[*running].title),
                QObject::tr("This one can be measured after it."), QObject::tr("Cancel")};
    if (const auto trouble = session.troubles().find(state.chosen); trouble != session.troubles().end())
        return {What::measure, StepTone::failure, QObject::tr("It could not be measured"),
                QString::fromStdString(trouble->second), QObject::tr("Measure again")};
    if (const StageOutcome* measured = session.outcomeAt(state.chosen)) {
        const StageOutcome& outcome = *measured;
        const QString summary = wordsOf(outcome).summary;
        if (!outcome.isGood && !outcome.changesRoom)
            return {What::measure, StepTone::failure, QObject::tr("This is not to be trusted"), summary,
                    QObject::tr("Measure again")};
        if (!outcome.isUsed && !session.asked().empty()) {
            const SimulatedQuestionWords words = wordsOfQuestion(session.asked());
            return {What::use, StepTone::warning, words.title, words.text, words.button};
        }
        if (!outcome.isUsed)
            return {What::use, outcome.isGood ? StepTone::good : StepTone::warning,
                    !outcome.isGood       ? QObject::tr("Something has changed")
                    : outcome.isSimulated ? QObject::tr("Simulated")
                                          : QObject::tr("Measured"),
                    summary, QObject::tr("Use it")};
        return {What::goOn, StepTone::good, QObject::tr("In use"), summary,
                session.next() ? QObject::tr("Go on") : QString()};
    }
    const QString again = QObject::tr("Measure again");
    const QString words = wordsOf(stand);
    switch (stand.how) {
    case StageStand::How::waits:
        return {What::goOn, StepTone::quiet, QObject::tr("Its turn comes later"),
                QObject::tr("%1 What it builds on is measured first.").arg(link.purpose), QObject::tr("What is next?")};
    case StageStand::How::spare:
        return measuringStep(state, StepTone::quiet, link.title,
                             words.isEmpty() ? link.purpose : words.left(1).toUpper() + words.mid(1) + ".",
                             QObject::tr("Measure in the lab"));
    case StageStand::How::measured:
        return measuringStep(state, StepTone::good, QObject::tr("Measured"), words, again);
    case StageStand::How::simulated:
        return measuringStep(state, StepTone::good, QObject::tr("Simulated"), words, again);
    case StageStand::How::stale:
        return measuringStep(state, StepTone::warning, QObject::tr("To be measured again"), words + ".", again);
    default:
        return measuringStep(state, StepTone::live, link.title, link.purpose, QObject::tr("Measure in the lab"));
    }
}

} // namespace

ChainStep stepOf(const ChainState& state) {
    ChainStep step = ownStepOf(state);
    if (state.restEnded != state.chosen || state.session.running()) return step;
    const QString ended = state.session.next() ? QObject::tr("Measuring all that is missing stopped here.")
                                               : QObject::tr("All that was missing is measured.");
    step.text = step.text.isEmpty() ? ended : ended + ' ' + step.text;
    return step;
}

ChainService::ChainService(StudioDocument& document, StudioLoop& loop, LabRoom& lab, Jobs& jobs, Notices& notices,
                           LiveService& live, TableOpener table, VersionTaker take)
    : document_(document), loop_(loop), lab_(lab), live_(live), table_(std::move(table)), take_(std::move(take)),
      jobs_(*this, jobs, notices) {
    state_.session.follow(*document.state().installation);
    state_.chosen = state_.session.next().value_or(0);
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::installation) follow();
    });
    connect(&loop, &StudioLoop::stoppedChanged, this, [this] {
        if (loop_.stopped()) cancel();
    });
    connect(&live, &LiveService::changed, this, [this] {
        state_.live = live_.stand();
        if (state_.live)
            state_.fraction = (static_cast<double>(state_.live->step) + state_.live->fraction) /
                              static_cast<double>(state_.live->steps);
        emit changed();
    });
    const auto solve = [this](const LivePlan& plan, const std::vector<LiveTake>& takes, bool isSimulated) {
        state_.live.reset();
        const std::shared_ptr<const Rig>& rig = document_.state().rig.rig;
        const std::optional<std::size_t> running = state_.session.running();
        if (!running || !rig) return cancel();
        run(*running, [stage = chainLinks()[*running].stage, site = StageSite{rig, *document_.state().installation},
                       plan, takes, isSimulated](const Progress& progress) {
            LiveBench bench(plan, takes, isSimulated);
            return outcomeOf(measureStage(*stage, site, bench, progress), site.room);
        });
    };
    connect(&live, &LiveService::finished, this, solve);
    connect(&jobs, &Jobs::progressed, this, [this, &jobs](int id) {
        for (const Jobs::Status& status : jobs.running()) {
            if (status.id != id || status.place != kChainPlace || !state_.session.running()) continue;
            state_.fraction = status.fraction;
            state_.stage = status.stage.left(1).toUpper() + status.stage.mid(1);
            emit changed();
        }
    });
}

void ChainService::choose(std::size_t link) {
    if (link >= chainLinks().size() || link == state_.chosen) return;
    state_.chosen = link;
    state_.session.withdrawQuestion();
    emit changed();
}

void ChainService::setWay(LinkWay way) {
    if (way == state_.way) return;
    if (state_.live) cancel();
    state_.session.endRest();
    state_.restEnded.reset();
    state_.way = way;
    for (std::size_t link = 0; link < chainLinks().size(); ++link) state_.session.forget(link);
    emit changed();
}

void ChainService::setFile(std::size_t link, std::size_t file, const std::filesystem::path& path) {
    if (link >= chainLinks().size() || file > chainLinks()[link].files.size()) return;
    auto& files = state_.files[link];
    files.resize(chainLinks()[link].files.size() + 1);
    if (file + 1 < files.size()) files.back().clear(); // what was chosen last is what is read
    files[file] = path;
    state_.session.forget(link);
    emit changed();
}

void ChainService::doNext() {
    switch (stepOf(state_).what) {
    case ChainStep::Do::measure:
        return measure();
    case ChainStep::Do::use:
        return use();
    case ChainStep::Do::cancel:
        return cancel();
    case ChainStep::Do::goOn:
        if (const auto next = state_.session.next()) choose(*next);
        return;
    default:
        return;
    }
}

void ChainService::measure() {
    state_.session.endRest();
    state_.restEnded.reset();
    begin(state_.chosen);
}

void ChainService::measureRest() {
    state_.session.measureRest();
    state_.restEnded.reset();
    goOn();
}

void ChainService::goOn() {
    if (const auto next = state_.session.next()) state_.chosen = *next;
    // In a real room nothing of the lab slips in between.
    const auto waitsForUser = [this](std::size_t link) {
        if (chainLinks()[link].stage->hasSequence()) return true;
        if (state_.way == LinkWay::files) return wayOf(state_, link) == LinkWay::lab || missingFile(state_, link);
        return state_.way == LinkWay::live;
    };
    if (const auto turn = state_.session.nextOfRest(waitsForUser)) return begin(*turn);
    endRestAt(state_.chosen);
    emit changed();
}

void ChainService::endRestAt(std::size_t link) {
    state_.session.endRest();
    state_.restEnded = link;
}

/// Null where it cannot be measured now.
std::function<StageOutcome(const Progress&)> ChainService::workOf(std::size_t link) {
    const ChainLink& measured = chainLinks()[link];
    const std::shared_ptr<const Rig>& rig = document_.state().rig.rig;
    if (!rig || measured.stage->hasSequence()) return nullptr;
    const StageSite site{rig, *document_.state().installation};
    if (wayOf(state_, link) == LinkWay::files) {
        if (missingFile(state_, link)) return nullptr;
        const std::vector<std::filesystem::path>& files = state_.files[link];
        if (files.back().empty())
            return [run = measured.fromFiles, task = FileTask{site.room, files}](const Progress& progress) {
                return outcomeOf(run(task, progress), task.believed);
            };
        return [stage = measured.stage, site, folder = files.back()](const Progress& progress) {
            StageRecording recording = readStageRecording(folder, progress.part(0.0, 0.2));
            StageResult result = solveStage(*stage, recording, site, progress.part(0.2, 1.0));
            return outcomeOf(MeasuredStage{std::move(recording), std::move(result)}, site.room);
        };
    }
    lab_.unpack();
    return [stage = measured.stage, site, truth = lab_.truth(), seed = seed_++](const Progress& progress) {
        LabBench bench(*site.rig, truth, seed);
        return outcomeOf(measureStage(*stage, site, bench, progress), site.room);
    };
}

void ChainService::begin(std::size_t link) {
    if (state_.session.running()) return;
    if (wayOf(state_, link) == LinkWay::live && !chainLinks()[link].notConnected.isEmpty()) return;
    if (wayOf(state_, link) == LinkWay::live)
        return chainLinks()[link].isWithTracker() ? beginLive(link) : beginOnTable(link);
    if (auto work = workOf(link)) run(link, std::move(work));
}

void ChainService::beginLive(std::size_t link) {
    const ChainLink& measured = chainLinks()[link];
    const std::shared_ptr<const Rig>& rig = document_.state().rig.rig;
    const Installation& room = *document_.state().installation;
    state_.session.forget(link);
    try {
        if (!rig || room.projectors.empty())
            throw InvalidInput("the room", "there is no device, or no projector", "open a rig, add a projector");
        if (const QString obstacle = live_.obstacle(measured.liveRoles); !obstacle.isEmpty()) {
            state_.session.fail(link, obstacle.toStdString());
            emit changed();
            return;
        }
        LivePlan plan{measured.liveRoles, measured.liveSteps(*rig, room)};
        state_.session.begin(link);
        state_.fraction = 0.0;
        live_.begin(std::move(plan), glm::dvec3(room.pointerTip), room.projectors.front().camera.size);
    } catch (const Error& error) {
        fail(link, error);
    }
}

/// By which the device is found, once both tracker and its body are known in the room; else null.
std::shared_ptr<const PoseBoard> ChainService::devicePoses() const {
    const auto& origins = document_.state().installation->origins;
    const auto& frame = loop_.frame();
    const bool isKnown = origins.tracker.isCalibrated() && origins.deviceBody.isCalibrated();
    return isKnown && frame && live_.obstacle({PoseRole::device}).isEmpty() ? frame->poses : nullptr;
}

void ChainService::beginOnTable(std::size_t link) {
    const std::shared_ptr<const Rig>& rig = document_.state().rig.rig;
    const Installation& room = *document_.state().installation;
    state_.session.forget(link);
    try {
        if (!rig) throw InvalidInput("the device", "there is none", "open a rig");
        run(link, [stage = chainLinks()[link].stage, site = StageSite{rig, room}, poses = devicePoses(),
                   bench = table_(room, chainLinks()[link].isMoved)](const Progress& progress) {
            if (!poses) return outcomeOf(measureStage(*stage, site, *bench, progress), site.room);
            const StageSite found{site.rig, withRestingDevice(site.room, *poses, progress)};
            return outcomeOf(measureStage(*stage, found, *bench, progress), found.room);
        });
    } catch (const std::exception& error) {
        fail(link, error);
    }
}

void ChainService::fail(std::size_t link, const std::exception& error) {
    const bool isCancelled = dynamic_cast<const Cancelled*>(&error) != nullptr;
    if (state_.session.goesOn() && !isCancelled) endRestAt(link);
    state_.session.fail(link, isCancelled ? std::string() : wordsOfError(error).toStdString());
    emit changed();
}

void ChainService::run(std::size_t link, std::function<StageOutcome(const Progress&)> work) {
    state_.session.begin(link);
    state_.fraction = 0.0;
    state_.stage.clear();
    state_.kept.erase(link);
    emit changed();
    if (!chainLinks()[link].warning.isEmpty()) emit handsOff();
    jobs_.runWith<StageOutcome>(
        kChainPlace, kChainPlace, QObject::tr("Measuring: %1").arg(chainLinks()[link].title), std::move(work),
        [this, link](StageOutcome outcome) { take(link, std::move(outcome)); },
        [this, link](const std::exception& error) { fail(link, error); });
}

void ChainService::take(std::size_t link, StageOutcome outcome) {
    const bool isOfRest = state_.session.goesOn();
    const auto doubted = state_.session.take(link, std::move(outcome), *document_.state().installation);
    if (doubted)
        document_.change(QObject::tr("Pointer tip in doubt"), [&doubted](StudioState& state) {
            state.installation = std::make_shared<const Installation>(*doubted);
        });
    if (isOfRest && state_.session.goesOn() && useOf(link)) return goOn();
    if (isOfRest) endRestAt(link);
    emit changed();
}

void ChainService::use() {
    useOf(state_.chosen);
    emit changed();
}

/// True where it is in use now, or changes nothing.
bool ChainService::useOf(std::size_t link) {
    const Installation& room = *document_.state().installation;
    if (!state_.session.mayUse(link, room)) {
        if (!state_.session.asked().empty()) state_.chosen = link;
        emit changed();
        return false;
    }
    const StageOutcome& outcome = *state_.session.outcomeAt(link);
    return !outcome.changesRoom || take_(versionOf(chainLinks()[link], outcome, room));
}

void ChainService::keepRecording(std::size_t link, const std::filesystem::path& folder) {
    const StageOutcome* outcome = state_.session.outcomeAt(link);
    if (!outcome || !outcome->recording) return;
    jobs_.run<int>(
        kKeepPlace, kKeepPlace, QObject::tr("Writing the recording"),
        [recording = outcome->recording, folder](const Progress& progress) {
            writeStageRecording(*recording, folder, progress);
            return 0;
        },
        [this, link, folder](int) {
            state_.kept[link] = folder;
            emit changed();
        });
}

void ChainService::cancel() {
    const bool runs = state_.session.running().has_value();
    state_.session.cancel(); // nothing is handed over after that
    if (!runs) return;
    state_.live.reset();
    live_.cancel();
    jobs_.stop(kChainPlace);
    emit changed();
}

void ChainService::follow() {
    state_.restEnded.reset(); // the room is another one now
    state_.session.follow(*document_.state().installation);
    emit changed();
}

} // namespace lumorph::studio
