#include "app/studio/calibration/calibration_state.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <QDateTime>
#include <QLocale>
#include <QObject>

#include "app/studio/calibration/simulated_question.h"
#include "calibration/report/calibrated_room.h"

namespace lumorph::studio {
namespace {

using How = CalibrationStep::How;
using Do = NextStep::Do;
using Tone = NextStep::Tone;

constexpr double kDoubtfulTransfer = 1.0; // projector pixels, held out

QString tr(const char* text) { return QObject::tr(text); }

QString number(double value, int decimals) { return QString::number(value, 'f', decimals); }

QString capitalised(const std::string& words) {
    QString text = QString::fromStdString(words).trimmed();
    if (text.isEmpty()) return text;
    text[0] = text[0].toUpper();
    if (!text.endsWith('.')) text += '.';
    return text;
}

/// What may be so, and only who was there can tell; empty for what is certain.
QString questionOf(Cause cause) {
    switch (cause) {
    case Cause::projectorSize:
        return tr("Is the projector's size right?");
    case Cause::phaseOrder:
        return tr("Does the projector hang upside down?");
    case Cause::unlikelyLength:
        return tr("Are these lengths right?");
    default:
        return {};
    }
}

QString wayWords(const CalibrationSetup& setup) {
    switch (setup.way) {
    case CaptureWay::folder:
        return setup.folder.empty() ? tr("Choose the folder of your images")
                                    : QString::fromStdString(setup.folder.filename().string());
    case CaptureWay::camera:
        return setup.camera.empty() ? tr("Choose a camera") : QString::fromStdString(setup.camera);
    case CaptureWay::crosshairs:
        return tr("Crosshairs on the device, no camera");
    case CaptureWay::lab:
        break;
    }
    return tr("Virtual lab, no hardware");
}

bool isChosen(const CalibrationSetup& setup) {
    if (setup.way == CaptureWay::folder) return !setup.folder.empty();
    return setup.way == CaptureWay::lab || !setup.camera.empty();
}

/// A refusal that other entries at the left mend.
bool isOfSetup(const Finding& finding) {
    return finding.cause == Cause::projectorSize || finding.cause == Cause::widthHeightSwapped ||
           finding.cause == Cause::squareSize;
}

CalibrationStep setupStep(const CalibrationState& state) {
    if (state.isImported && state.result) return {"setup", tr("Set up"), How::good, wayWords(state.result->setup)};
    CalibrationStep step{"setup", tr("Set up"), How::good, wayWords(state.setup)};
    if (const QString problem = problemOf(state.setup); !problem.isEmpty())
        step.how = How::needsYou, step.words = problem;
    else if (!isChosen(state.setup))
        step.how = How::needsYou;
    else if (state.refusal && isOfSetup(*state.refusal))
        step.how = How::needsYou, step.words = wordsOf(*state.refusal).title;
    return step;
}

const CalibrationPose* refusedPose(const CalibrationState& state) {
    const auto found =
        std::ranges::find_if(state.poses, [](const CalibrationPose& pose) { return pose.refusal && !pose.leftOut; });
    return found == state.poses.end() ? nullptr : &*found;
}

CalibrationStep posesStep(const CalibrationState& state) {
    CalibrationStep step{"poses", tr("Poses of the board"), How::notBegun, {}};
    const int counting = state.counting();
    if (state.isImported && state.result) {
        const auto views = state.result->solved.views.size();
        step.words = views == 0 ? tr("None in the file") : tr("%1, of which the file has figures alone").arg(views);
        return step;
    }
    const bool works = state.work == CalibrationState::Work::reading || state.work == CalibrationState::Work::capturing;
    const auto warned = std::ranges::count_if(
        state.poses, [](const CalibrationPose& pose) { return pose.counts() && !pose.warnings.empty(); });
    if (works) {
        step.how = How::running;
        step.words = state.stage;
    } else if (const CalibrationPose* refused = refusedPose(state)) {
        step.how = How::refused;
        step.words = wordsOf(*refused->refusal).title;
    } else if (state.refusal && !state.refusal->view.empty()) {
        step.how = How::refused;
        step.words = wordsOf(*state.refusal).title;
    } else if (state.poses.empty()) {
        step.words = tr("None yet");
        if (isChosen(state.setup)) step.how = How::needsYou;
    } else if (counting < kFewestPoses || (state.setup.way != CaptureWay::folder && counting < state.setup.poses)) {
        step.how = How::needsYou;
        step.words =
            tr("%1 of %2").arg(counting).arg(state.setup.way == CaptureWay::folder ? kFewestPoses : state.setup.poses);
    } else {
        step.how = warned > 0 ? How::doubtful : How::good;
        step.words = warned > 0 ? tr("%1, of which %2 with a warning").arg(counting).arg(warned)
                                : tr("%1, all readable").arg(counting);
    }
    return step;
}

QString lensWords(const CalibratedDevice& device) {
    const std::optional<double> sigma = whereSaid(device.sigma[kFocalLength]), error = whereSaid(device.rms);
    return tr("focal %1%2 px, error %3")
        .arg(number(device.lens[kFocalLength], 0), sigma ? " ± " + number(*sigma, 1) : QString(),
             error ? number(*error, 2) + " px" : tr("unknown"));
}

/// Of a file with a camera alone, the projector.
bool isEmpty(const CalibratedDevice& device) { return !(device.lens[kFocalLength] > 0.0); }

CalibrationStep solvedStep(const CalibrationState& state, const QString& id, const QString& title,
                           CalibratedDevice ProcamCalibration::*device) {
    CalibrationStep step{id, title, How::notBegun, tr("Follows from the poses")};
    if (state.work == CalibrationState::Work::solving) {
        step.how = How::running;
        step.words = state.stage;
    } else if (state.refusal && state.counting() > 0) {
        step.how = How::refused;
        step.words = tr("No result that could be trusted");
    } else if (state.result && isEmpty(state.result->solved.*device)) {
        step.words = tr("Not in this file");
    } else if (state.result) {
        const auto doubts = doubtsOf(*state.result);
        step.how = doubts.empty() ? How::good : How::doubtful;
        step.words = doubts.empty() ? lensWords(state.result->solved.*device) : wordsOfDoubt(doubts.front()).title;
    }
    return step;
}

QString dayWords(const std::string& date) {
    const QDateTime when = QDateTime::fromString(QString::fromStdString(date), Qt::ISODate).toLocalTime();
    return when.isValid() ? QLocale().toString(when.date(), QLocale::ShortFormat) : QString::fromStdString(date);
}

CalibrationStep roomStep(const CalibrationState& state) {
    CalibrationStep step{"room", tr("In the room"), How::notBegun, tr("The scene uses an assumed projector")};
    if (!state.roomDate.empty()) {
        step.how = How::good;
        step.words = (state.isRoomSimulated ? tr("In use: simulated %1") : tr("In use: measured %1"))
                         .arg(dayWords(state.roomDate));
    }
    if (!state.isSolved()) return step;
    step.how = state.isUsed() ? How::good : How::needsYou;
    step.words = state.isUsed() ? tr("The scene uses this calibration") : tr("Not in use yet");
    return step;
}

NextStep refusedNext(const CalibrationState& state, const Finding& finding) {
    const FindingWords words = wordsOf(finding);
    NextStep next{Do::nothing, Tone::failure, words.title, words.text + ' ' + words.remedy, {}};
    const bool isFolder = state.setup.way == CaptureWay::folder;
    const bool isOfPose = !finding.view.empty();
    if (finding.cause == Cause::widthHeightSwapped && isFolder) {
        next.what = Do::exchangeSides;
        next.button = tr("Exchange width and height");
    } else if (!isFolder && isOfPose) {
        next.what = Do::photographAgain;
        next.button = tr("Photograph this pose again");
    } else if (!isFolder) {
        next.what = Do::photograph;
        next.button = tr("Photograph another pose");
    } else if (isOfPose && (finding.cause == Cause::rigMoved || finding.cause == Cause::boardNotFound ||
                            finding.cause == Cause::boardUnlit || finding.cause == Cause::lateFrame ||
                            finding.cause == Cause::mirrored || finding.cause == Cause::unreadableImage ||
                            finding.cause == Cause::doubledImage || finding.cause == Cause::missingImage ||
                            finding.cause == Cause::imageSize)) {
        next.what = Do::leaveOut;
        next.button = tr("Leave %1 out").arg(QString::fromStdString(finding.view));
    } else if (!isOfSetup(finding)) { // what is set wrong is not mended by reading again
        next.what = Do::read;
        next.button = tr("Read again");
    }
    return next;
}

NextStep workNext(const CalibrationState& state) {
    NextStep next{Do::stop, Tone::live, {}, state.stage, tr("Cancel")};
    switch (state.work) {
    case CalibrationState::Work::reading:
        next.title = tr("Reading the poses");
        break;
    case CalibrationState::Work::capturing:
        next.title = tr("Photographing pose %1").arg(freeNumber(state) + 1);
        next.text = state.setup.way == CaptureWay::lab
                        ? tr("The lab's projector shows its patterns one after the other.")
                        : tr("Touch nothing: camera, projector and board stand still until all patterns were shown.");
        break;
    default:
        next.title = tr("Working out camera and projector");
    }
    return next;
}

NextStep photographNext(const CalibrationState& state) {
    NextStep next{Do::photograph,
                  Tone::quiet,
                  {},
                  {},
                  tr("Photograph pose %1 of %2").arg(state.counting() + 1).arg(state.setup.poses)};
    const bool isLab = state.setup.way == CaptureWay::lab;
    if (freeNumber(state) == 0) {
        next.title = isLab ? tr("Begin with the board flat on the table") : tr("Lay the board flat on the table");
        next.text = isLab ? tr("The lab lays the board for you; its outline shows where. From this pose the studio "
                               "learns where the table is.")
                          : tr("Where the device will stand, its long side along the front. From this pose the studio "
                               "learns where the table is.");
    } else {
        next.title = tr("Tilt the board as the outline shows");
        next.text = isLab ? tr("Each pose is tilted to another side, so that distances can be told from focal lengths.")
                          : tr("Prop it up so that it fills the outline, let go, and wait until it stands still. Each "
                               "pose is tilted to another side.");
    }
    return next;
}

/// Whether another pose is worth the trouble.
QString nextPoseWords(const CalibrationState& state) {
    const auto& next = state.result->next;
    if (!next || state.setup.way == CaptureWay::folder) return {};
    if (!next->worthIt) return tr("Another pose is no longer worth it.");
    return tr("Another pose, as outlined in the live picture, would lower the uncertainty over the space that the "
              "poses cover by %1 %.")
        .arg(number(100.0 * (1.0 - next->meanAfter / next->meanBefore), 0));
}

/// What of a calibration from a file would be used.
QString importWords(const CalibrationResult& result) {
    const bool hasPlace = !tableViewsOf(result.solved).empty();
    QString words =
        result.solved.projector.size.empty() ? tr("It has a camera alone.") : tr("It has a projector and a camera.");
    words += ' ' + (hasPlace ? tr("Lenses and places are taken over; what the file does not say is unknown.")
                             : tr("It has no pose of a board, so lenses alone are taken over; where the devices stand "
                                  "stays as it is."));
    return words;
}

NextStep solvedNext(const CalibrationState& state) {
    const CalibrationResult& result = *state.result;
    const auto doubts = doubtsOf(result);
    NextStep next;
    next.tone = doubts.empty() ? Tone::good : Tone::warning;
    const QString within = result.millimetres()
                               ? tr("Light lands within %1 mm of where it should, in 95 of 100 places.")
                                     .arg(number(*result.millimetres(), 2))
                               : tr("How far it can be trusted needs more poses.");
    if (state.isUsed()) {
        next.title = tr("Calibrated, and in use");
        next.text = (state.isImported && !result.millimetres() ? QString() : within + ' ') +
                    tr("Undo takes it back; in Versions it can be compared with those before.");
        return next;
    }
    next.what = Do::use;
    next.button = tr("Use this calibration");
    if (!state.askedBeside.empty()) {
        const SimulatedQuestionWords words = wordsOfQuestion(state.askedBeside);
        next.tone = Tone::warning;
        next.title = words.title;
        next.text = words.text;
        next.button = words.button;
        return next;
    }
    if (state.isImported) {
        next.title = tr("A calibration from a file");
        next.text = importWords(result);
        if (doubts.empty()) {
            next.tone = Tone::quiet;
        } else {
            const FindingWords words = wordsOf(doubts.front());
            next.text = words.text + ' ' + words.remedy + ' ' + next.text;
        }
        return next;
    }
    if (doubts.empty()) {
        next.title = tr("This calibration is good");
        next.text = within + ' ' + nextPoseWords(state);
    } else {
        const FindingWords words = wordsOfDoubt(doubts.front());
        next.title = words.title;
        next.text = words.text + ' ' + words.remedy;
        const Cause cause = doubts.front().cause;
        const bool isQuestion = !questionOf(cause).isEmpty();
        if (cause == Cause::projectorSize)
            next.title = tr("Has the projector %1 × %2 pixels?")
                             .arg(result.solved.projector.size.width)
                             .arg(result.solved.projector.size.height);
        if (isQuestion) next.button = tr("Yes, use this calibration");
        const bool isHelpedByPose = cause != Cause::clipped && !isQuestion;
        if (state.setup.way != CaptureWay::folder && isHelpedByPose) {
            next.what = Do::photograph;
            next.button = tr("Photograph another pose");
        }
    }
    return next;
}

QString placeOf(const Finding& finding) {
    const QString view = QString::fromStdString(finding.view);
    QString file = QString::fromStdString(finding.file);
    if (view.isEmpty()) return file;
    return file.isEmpty() ? view : view + ", " + file;
}

QString causeTitle(Cause cause) {
    switch (cause) {
    case Cause::missingImage:
        return tr("An image is missing");
    case Cause::doubledImage:
        return tr("An image is there twice");
    case Cause::lateFrame:
        return tr("The camera was one picture late");
    case Cause::wrongOrder:
        return tr("The images show other patterns than expected");
    case Cause::unreadableImage:
        return tr("An image cannot be read");
    case Cause::imageSize:
        return tr("The images differ in size");
    case Cause::blackWhiteSwapped:
        return tr("White and black are exchanged");
    case Cause::inverseSwapped:
        return tr("Patterns and their inverses are exchanged");
    case Cause::mirrored:
        return tr("The picture is mirrored");
    case Cause::rigMoved:
        return tr("Something moved");
    case Cause::projectorSize:
        return tr("The projector has another size");
    case Cause::widthHeightSwapped:
        return tr("Width and height are exchanged");
    case Cause::frontalViews:
        return tr("The board was not tilted enough");
    case Cause::tooFewViews:
        return tr("More poses are needed");
    case Cause::clipped:
        return tr("The board is overexposed");
    case Cause::boardNotFound:
        return tr("The board is not found");
    case Cause::boardUnlit:
        return tr("The projector's light does not reach the board");
    case Cause::modelDoesNotFit:
        return tr("The poses contradict each other");
    case Cause::undetermined:
        return tr("The poses leave something open");
    case Cause::underexposed:
        return tr("The pictures are too dark");
    case Cause::exposureDrifts:
        return tr("The brightness changes by itself");
    case Cause::keystone:
        return tr("The projector bends or scales its picture");
    case Cause::boardWarped:
        return tr("The board is not flat");
    case Cause::squareSize:
        return tr("The board's squares are not as said");
    case Cause::strangeLens:
        return tr("A lens bends light in a way that no model knows");
    case Cause::projectorGamma:
        return tr("The projector's brightness curve bends the patterns");
    case Cause::cameraRefocused:
        return tr("The camera has refocused");
    case Cause::wrongUnits:
        return tr("Lengths in different units");
    case Cause::doubledRows:
        return tr("A recording repeats itself");
    case Cause::clockJumps:
        return tr("A clock jumps");
    case Cause::clocksUnknown:
        return tr("Nothing tells how the clocks differ");
    case Cause::motionDegenerate:
        return tr("A motion is missing");
    case Cause::bodySwapped:
        return tr("Another body was tracked for a while");
    case Cause::tipSlipped:
        return tr("The tip left its dimple");
    case Cause::tipWrong:
        return tr("The pointer's tip is elsewhere");
    case Cause::trackerLost:
        return tr("The tracker lost the body");
    case Cause::notANumber:
        return tr("Numbers that are none");
    case Cause::pointSuspicious:
        return tr("Points that the others contradict");
    case Cause::freshPointsFar:
        return tr("Check points contradict it");
    case Cause::servoDead:
        return tr("A servo does not move");
    case Cause::servoSwapped:
        return tr("Two servos are exchanged");
    case Cause::servoReversed:
        return tr("A servo runs the wrong way");
    case Cause::servoJammed:
        return tr("A servo meets a stop");
    case Cause::cameraSlow:
        return tr("The camera is too slow");
    case Cause::flashNotSeen:
        return tr("The flashes are not seen");
    case Cause::nothingMoves:
        return tr("Nothing moves");
    case Cause::motionPeriodic:
        return tr("The motion repeats itself");
    case Cause::cameraSaturates:
        return tr("The camera is overexposed");
    case Cause::lightTooDark:
        return tr("There is too little light");
    case Cause::ambientChanges:
        return tr("The light of the room has changed");
    case Cause::cameraAdjusts:
        return tr("The camera changes its exposure by itself");
    case Cause::responseNotRising:
        return tr("A brighter value makes less light");
    case Cause::surfaceUnseen:
        return tr("The camera sees too little of the light");
    case Cause::cameraMoved:
        return tr("Camera or projector moved between poses");
    case Cause::repeatedPoses:
        return tr("The same view twice");
    case Cause::passedOver:
        return tr("Files were passed over");
    case Cause::noisy:
        return tr("The pictures are too noisy");
    case Cause::bitOrder:
        return tr("The patterns stand in another order");
    case Cause::periodCount:
        return tr("The stripes have another number of periods");
    case Cause::phaseOrder:
        return tr("Phase steps are exchanged");
    case Cause::outOfFocus:
        return tr("The picture is out of focus");
    case Cause::boardSize:
        return tr("The board has another number of corners");
    case Cause::boardKind:
        return tr("It is another board");
    case Cause::handInView:
        return tr("Something covers the board");
    case Cause::foreignImage:
        return tr("An image of another pose");
    case Cause::unlikelyLength:
        return tr("A length that no room has");
    case Cause::quaternionOrder:
        return tr("Quaternions in two orders");
    case Cause::inverted:
        return tr("One recording is inverted");
    case Cause::timeUnit:
        return tr("Times in another unit");
    case Cause::turnsInPlace:
        return tr("The body turned in place");
    case Cause::rowsOutOfOrder:
        return tr("Rows out of order");
    case Cause::lensModel:
        return tr("A lens model that cannot be used");
    default:
        return tr("This capture cannot be trusted");
    }
}

} // namespace

int CalibrationState::counting() const {
    return static_cast<int>(std::ranges::count_if(poses, [](const CalibrationPose& pose) { return pose.counts(); }));
}

std::vector<CalibrationStep> stepsOf(const CalibrationState& state) {
    return {setupStep(state), posesStep(state), solvedStep(state, "camera", tr("Camera"), &ProcamCalibration::camera),
            solvedStep(state, "projector", tr("Projector"), &ProcamCalibration::projector), roomStep(state)};
}

QString howWords(CalibrationStep::How how) {
    switch (how) {
    case How::needsYou:
        return tr("Needs you");
    case How::running:
        return tr("Running");
    case How::good:
        return tr("Good");
    case How::doubtful:
        return tr("Doubtful");
    case How::refused:
        return tr("Refused");
    case How::notBegun:
        break;
    }
    return tr("Not begun");
}

namespace {

NextStep stepAfter(const CalibrationState& state) {
    const bool showsImport = state.isImported && state.result;
    if (state.setup.way == CaptureWay::crosshairs && !showsImport) return {};
    if (state.work != CalibrationState::Work::none) return workNext(state);
    if (!state.trouble.isEmpty())
        return {state.setup.way == CaptureWay::folder ? Do::chooseFolder : Do::photograph, Tone::failure,
                tr("That did not work"), state.trouble,
                state.setup.way == CaptureWay::folder ? tr("Choose a folder") : tr("Try again")};
    if (state.refusal) return refusedNext(state, *state.refusal);
    if (const CalibrationPose* refused = refusedPose(state)) return refusedNext(state, *refused->refusal);
    if (showsImport) return solvedNext(state);
    if (const QString problem = problemOf(state.setup); !problem.isEmpty())
        return {Do::nothing, Tone::warning, tr("Something in the set-up cannot be"), problem, {}};
    const bool isFolder = state.setup.way == CaptureWay::folder;
    if (isFolder && state.setup.folder.empty())
        return {Do::chooseFolder, Tone::quiet, tr("Which images?"),
                tr("A folder with one folder for each pose of the board, each with the photographs of all patterns in "
                   "their order."),
                tr("Choose a folder")};
    if (state.setup.way == CaptureWay::camera && state.setup.camera.empty())
        return {Do::nothing,
                Tone::quiet,
                tr("Which camera?"),
                tr("At the left: one of this machine, one that is found on the network, or its address."),
                {}};
    const bool wantsMore = !isFolder && state.counting() < state.setup.poses;
    if (state.result && (!wantsMore || state.isUsed()) && !(isOld(state) && !wantsMore)) return solvedNext(state);
    if (isFolder && state.poses.empty())
        return {Do::read, Tone::quiet, tr("Say which board and projector, then read the images"),
                tr("What is set at the left must be what was photographed: count the board's inner corners and measure "
                   "one square."),
                tr("Read the images")};
    if (isFolder && !state.isReadWhole)
        return {Do::read, Tone::quiet, tr("Not all images were read"), {}, tr("Read the rest")};
    if (wantsMore) return photographNext(state);
    return {Do::solve,
            Tone::quiet,
            isOld(state) ? tr("A pose is not in the result yet") : tr("All poses are there"),
            {},
            tr("Work out camera and projector")};
}

} // namespace

NextStep nextOf(const CalibrationState& state) {
    NextStep next = stepAfter(state);
    if (!state.arriving.isEmpty()) next.text += (next.text.isEmpty() ? QString() : " ") + state.arriving;
    return next;
}

FindingWords wordsOfDoubt(const Finding& finding) {
    FindingWords words = wordsOf(finding);
    if (const QString question = questionOf(finding.cause); !question.isEmpty()) words.title = question;
    return words;
}

FindingWords wordsOf(const Finding& finding) {
    FindingWords words{causeTitle(finding.cause), {}, {}};
    const QString place = placeOf(finding);
    words.text = (place.isEmpty() ? QString() : place + ": ") +
                 (place.isEmpty() ? capitalised(finding.why) : QString::fromStdString(finding.why) + '.');
    // The command line's options have names of their own in the window.
    QString remedy = capitalised(finding.remedy);
    remedy.replace("nothing has to be done; --board", tr("nothing has to be done; the board"))
        .replace("Nothing has to be done; --board", tr("Nothing has to be done; the board"))
        .replace("--board", tr("the board at the left"))
        .replace("--pattern", tr("the patterns"))
        .replace("--projector", tr("the projector's size at the left"));
    remedy.replace(", or say so in an order file", "");
    words.remedy = remedy;
    return words;
}

namespace {

/// What is said and needs nothing done.
bool isRemark(const Finding& finding) {
    return finding.cause == Cause::passedOver || finding.cause == Cause::boardKind ||
           finding.cause == Cause::pointSuspicious; // left out
}

} // namespace

std::vector<Finding> remarksOf(const CalibrationResult& result) {
    std::vector<Finding> remarks;
    std::ranges::copy_if(result.solved.warnings, std::back_inserter(remarks), isRemark);
    return remarks;
}

std::vector<Finding> doubtsOf(const CalibrationResult& result) {
    std::vector<Finding> doubts = result.solved.warnings;
    std::erase_if(doubts, isRemark);
    double worst = 0.0;
    std::string worstName;
    for (const ViewQuality& view : result.solved.views)
        if (view.heldOut && *view.heldOut > worst) worst = *view.heldOut, worstName = view.name;
    if (worst > kDoubtfulTransfer && doubts.empty())
        doubts.push_back({Cause::modelDoesNotFit, worstName, "",
                          "the other poses put its light " + number(worst, 1).toStdString() + " pixels beside",
                          "photograph it again, or leave it out"});
    return doubts;
}

std::optional<double> CalibrationResult::millimetres() const {
    if (!plan || !std::isfinite(plan->worst)) return heldOutMillimetres;
    return std::max(plan->worst, heldOutMillimetres.value_or(0.0));
}

namespace {

/// The pattern, or the order file in its place.
std::string patternOf(const CalibrationSetup& setup) {
    return setup.order.empty() ? setup.pattern : setup.order.string();
}

} // namespace

CalibrationRecord recordOf(const CalibrationResult& result) {
    CalibrationRecord record;
    record.result = result.solved;
    record.source.date = result.date;
    record.source.board = boardText(result.setup.board);
    record.source.pattern = patternOf(result.setup);
    record.source.isSimulated = result.isSimulated;
    record.source.inputs = {result.setup.way == CaptureWay::folder ? result.setup.folder.string()
                                                                   : wayWords(result.setup).toStdString()};
    return record;
}

InstallationVersion versionOf(const CalibrationState& state, const Installation& installation) {
    const CalibrationResult& result = *state.result;
    InstallationVersion version;
    version.date = result.date;
    const bool hasProjector = !isEmpty(result.solved.projector);
    version.title = !state.isImported ? "Projector and camera by structured light"
                    : hasProjector    ? "Projector and camera from a file"
                                      : "Camera from a file";
    const auto add = [&](const char* name, const std::optional<double>& value, const char* unit) {
        if (value) version.figures.push_back({name, *value, unit});
    };
    std::optional<double> heldOut;
    for (const ViewQuality& view : result.solved.views)
        if (view.heldOut) heldOut = std::max(heldOut.value_or(0.0), *view.heldOut);
    add("Light lands within", result.millimetres(), "mm");
    add("Truly beside", result.trueMillimetres, "mm");
    add("Held out, worst", heldOut, "px");
    add("Camera error", whereSaid(result.solved.camera.rms), "px");
    add("Projector error", whereSaid(result.solved.projector.rms), "px");
    add("Projector focal", whereSaid(result.solved.projector.lens[kFocalLength]), "px");
    add("Camera focal", result.solved.camera.lens[kFocalLength], "px");
    add("Poses", whereSaid(static_cast<double>(result.solved.views.size())), "");
    version.inputs = {wayWords(result.setup).toStdString(), boardWords(result.setup.board).toStdString(),
                      patternOf(result.setup)};
    if (!state.savedIn.empty()) version.inputs.push_back("poses in " + state.savedIn.string());
    version.result = calibrationText(recordOf(result));
    version.installation = installation;
    version.isSimulated = result.isSimulated;
    return version;
}

bool isOld(const CalibrationState& state) {
    return state.result && !state.isImported &&
           state.result->solved.views.size() != static_cast<std::size_t>(state.counting());
}

int freeNumber(const CalibrationState& state) {
    const auto isThere = [&](int number) {
        return std::ranges::any_of(state.poses, [&](const CalibrationPose& pose) {
            const bool isRefused = pose.refusal || (state.refusal && state.refusal->view == pose.name);
            return pose.name == nameOfPose(number) && !isRefused;
        });
    };
    int number = 0;
    while (isThere(number)) ++number;
    return number;
}

std::vector<ViewObservations> countingViews(const CalibrationState& state) {
    std::vector<ViewObservations> views;
    for (const CalibrationPose& pose : state.poses)
        if (pose.counts()) views.push_back(*pose.seen);
    return views;
}

} // namespace lumorph::studio
