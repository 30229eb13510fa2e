#include "app/studio/calibration/chain_service.h"

#include <utility>

#include <QObject>

#include "calibration/lab/true_room.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr auto kChainPlace = "chain"; // of jobs and notices
constexpr std::uint32_t kLabSeed = 7;

QString wordsOfError(const std::exception& error) {
    const Notice notice = noticeOf(error);
    QString words = notice.subject.isEmpty() ? notice.why : notice.subject + ": " + notice.why;
    if (!notice.remedy.isEmpty()) words += ". " + notice.remedy.left(1).toUpper() + notice.remedy.mid(1) + '.';
    return words;
}

} // namespace

ChainStep stepOf(const ChainState& state) {
    using Do = ChainStep::Do;
    using Tone = ChainStep::Tone;
    const ChainLink& link = chainLinks()[state.chosen];
    const LinkStand& stand = state.stands[state.chosen];
    if (state.running == state.chosen)
        return {Do::cancel, Tone::live, QObject::tr("Measuring: %1").arg(link.title), state.stage,
                QObject::tr("Cancel")};
    if (state.running)
        return {Do::cancel, Tone::live, QObject::tr("Measuring: %1").arg(chainLinks()[*state.running].title),
                QObject::tr("This one can be measured after it."), QObject::tr("Cancel")};
    if (const auto trouble = state.troubles.find(state.chosen); trouble != state.troubles.end())
        return {Do::measure, Tone::failure, QObject::tr("It could not be measured"), trouble->second,
                QObject::tr("Measure again")};
    if (const auto found = state.outcomes.find(state.chosen); found != state.outcomes.end()) {
        const LinkOutcome& outcome = found->second;
        const QString summary = outcome.summary;
        if (!outcome.isGood && !outcome.installation)
            return {Do::measure, Tone::failure, QObject::tr("This is not to be trusted"), summary,
                    QObject::tr("Measure again")};
        if (!outcome.isUsed)
            return {Do::use, outcome.isGood ? Tone::good : Tone::warning,
                    outcome.isGood ? QObject::tr("Measured") : QObject::tr("Something has changed"), summary,
                    QObject::tr("Use it")};
        return {Do::goOn, Tone::good, QObject::tr("In use"), summary,
                nextLink(state.stands) ? QObject::tr("Go on") : QString()};
    }
    switch (stand.how) {
    case LinkStand::How::waits:
        return {Do::goOn, Tone::quiet, QObject::tr("Its turn comes later"),
                QObject::tr("%1 What it builds on is measured first.").arg(link.purpose), QObject::tr("What is next?")};
    case LinkStand::How::measured:
        return {Do::measure, Tone::good, QObject::tr("Measured"), stand.words, QObject::tr("Measure again")};
    case LinkStand::How::stale:
        return {link.inLab ? Do::measure : Do::sequence, Tone::warning, QObject::tr("To be measured again"),
                stand.words + ".", link.inLab ? QObject::tr("Measure again") : QObject::tr("Open it")};
    default:
        return {link.inLab ? Do::measure : Do::sequence, Tone::live, link.title, link.purpose,
                link.inLab ? QObject::tr("Measure in the lab") : QObject::tr("Open it")};
    }
}

ChainService::ChainService(StudioDocument& document, StudioLoop& loop, Jobs& jobs, Notices& notices, VersionTaker take)
    : document_(document), loop_(loop), take_(std::move(take)), jobs_(*this, jobs, notices) {
    state_.stands = standsOf(*document.state().installation, checked_);
    state_.chosen = nextLink(state_.stands).value_or(0);
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::installation) follow();
    });
    connect(&loop, &StudioLoop::stoppedChanged, this, [this] {
        if (loop_.stopped()) cancel();
    });
    connect(&jobs, &Jobs::progressed, this, [this, &jobs](int id) {
        for (const Jobs::Status& status : jobs.running()) {
            if (status.id != id || status.place != kChainPlace || !state_.running) continue;
            state_.fraction = status.fraction;
            state_.stage = status.stage.left(1).toUpper() + status.stage.mid(1);
            emit changed();
        }
    });
}

void ChainService::choose(std::size_t link) {
    if (link >= chainLinks().size() || link == state_.chosen) return;
    state_.chosen = link;
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
        if (const auto next = nextLink(state_.stands)) choose(*next);
        return;
    default:
        return;
    }
}

void ChainService::measure() {
    state_.goesOn = false;
    begin(state_.chosen);
}

void ChainService::measureRest() {
    state_.goesOn = true;
    goOn();
}

void ChainService::goOn() {
    const auto next = nextLink(state_.stands);
    if (!next || !chainLinks()[*next].inLab) {
        state_.goesOn = false;
        if (next) state_.chosen = *next;
        emit changed();
        return;
    }
    state_.chosen = *next;
    begin(*next);
}

/// The lab has one truth, whatever is believed of it meanwhile.
const Installation& ChainService::truth(const Rig& rig) {
    if (!truth_ || truthOf_ != document_.state().rig.rig) {
        truth_ = trueRoom(*document_.state().installation, rig.actuators(), kLabSeed);
        truthOf_ = document_.state().rig.rig;
    }
    return *truth_;
}

void ChainService::begin(std::size_t link) {
    const std::shared_ptr<const Rig>& rig = document_.state().rig.rig;
    const ChainLink& measured = chainLinks()[link];
    if (!rig || !measured.inLab || state_.running) return;
    LinkTask task{rig, *document_.state().installation, truth(*rig), seed_++};
    state_.running = link;
    state_.fraction = 0.0;
    state_.stage.clear();
    state_.outcomes.erase(link);
    state_.troubles.erase(link);
    emit changed();
    jobs_.runWith<LinkOutcome>(
        kChainPlace, kChainPlace, QObject::tr("Measuring: %1").arg(measured.title),
        [run = measured.inLab, task = std::move(task)](const Progress& progress) { return run(task, progress); },
        [this, link](LinkOutcome outcome) { take(link, std::move(outcome)); },
        [this, link](const std::exception& error) {
            state_.running.reset();
            state_.goesOn = false;
            if (dynamic_cast<const Cancelled*>(&error) == nullptr) state_.troubles[link] = wordsOfError(error);
            emit changed();
        });
}

void ChainService::take(std::size_t link, LinkOutcome outcome) {
    state_.running.reset();
    const bool good = outcome.isGood;
    if (chainLinks()[link].origin == nullptr) checked_ = good ? utcDate() : std::string();
    state_.outcomes[link] = std::move(outcome);
    follow();
    if (!state_.goesOn) return;
    state_.goesOn = good && useOf(link);
    if (state_.goesOn) goOn();
}

void ChainService::use() {
    useOf(state_.chosen);
    emit changed();
}

/// True where it is in use now, or changes nothing.
bool ChainService::useOf(std::size_t link) {
    const auto found = state_.outcomes.find(link);
    if (found == state_.outcomes.end()) return false;
    if (!found->second.installation) return found->second.isGood;
    return take_(versionOf(chainLinks()[link], found->second, *document_.state().installation));
}

void ChainService::cancel() {
    state_.goesOn = false;
    if (!state_.running) return;
    state_.running.reset(); // nothing is handed over after a cancel
    jobs_.stop(kChainPlace);
    emit changed();
}

void ChainService::follow() {
    const Installation& room = *document_.state().installation;
    state_.stands = standsOf(room, checked_);
    for (auto& [link, outcome] : state_.outcomes) outcome.isUsed = isUsed(chainLinks()[link], outcome, room);
    emit changed();
}

} // namespace lumorph::studio
