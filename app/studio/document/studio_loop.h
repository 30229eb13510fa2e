#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <QObject>
#include <QTimer>

#include "app/studio/document/studio_document.h"
#include "core/loop/frame_source.h"
#include "core/loop/match_thread.h"
#include "core/loop/show_program.h"

namespace lumorph::studio {

/// The match loop as the window sees it: the document and what the user does right now go in, frames come out as a
/// signal. Lives in the window's thread; the work is done in the loop's.
class StudioLoop : public QObject {
    Q_OBJECT
public:
    explicit StudioLoop(StudioDocument& document, QObject* parent = nullptr);
    ~StudioLoop() override;

    /// The newest frame; empty before the first.
    [[nodiscard]] const std::shared_ptr<const MatchFrame>& frame() const noexcept { return frame_; }
    [[nodiscard]] double rate() const noexcept;      ///< frames a second
    [[nodiscard]] double matchRate() const noexcept; ///< matches a second that were handed to the window

    [[nodiscard]] bool stopped() const noexcept { return stopped_; }
    /// STOP until `resume`: the show holds still, and a connected device lets go of its servos. Pressed again it is
    /// ordered again.
    void stop();
    void resume();
    /// Who moves the servos by the newest wish: the recording that is shown, the dance, the hand where poses play, the
    /// program that shows and was not sent off the servos, else whom the document says.
    [[nodiscard]] Driver driver() const noexcept;
    [[nodiscard]] bool dancing() const noexcept { return dancing_; }
    /// Random smooth moves; takes the rig off the target.
    void setDancing(bool dancing);
    /// Poses move the servos by hand in place of the document's strokes, until it is set to nothing, or somebody else
    /// takes the servos or brings another device. The sequence is playable with the rig.
    void setPosePlay(std::shared_ptr<const PosePlay> play);
    [[nodiscard]] const std::shared_ptr<const PosePlay>& posePlay() const noexcept { return posePlay_; }
    /// Time of the target's animation to show while it does not play.
    void seek(double seconds);
    void setTint(bool shown);
    /// The scene's own time, of which animations, waves and moving textures go by.
    [[nodiscard]] bool scenePlaying() const noexcept { return scenePlaying_; }
    void setScenePlaying(bool playing);
    void seekScene(double seconds);
    /// Tracked heads and device; empty: the scene's own eye and place.
    void setPoses(std::shared_ptr<const PoseBoard> poses);
    /// How long a frame takes to its light, seconds: poses are predicted by it.
    void setLightDelay(double seconds);
    void setRate(double framesPerSecond);
    /// Paused, only a change makes a frame and time stands still; ending the pause makes one at once.
    void setPaused(bool paused);
    [[nodiscard]] bool paused() const noexcept { return paused_; }
    /// In which the program that shows writes.
    void setLanguage(Language language);
    /// Frames of another source instead of the loop's own, until it is set to nothing; the show then goes on from where
    /// the actuators stand, under their limits. Poses of trackers wait meanwhile.
    void setSource(std::shared_ptr<FrameSource> source);
    [[nodiscard]] bool showsSource() const noexcept { return source_ != nullptr; }
    /// A program shows, and moves the servos until somebody else takes them, until it is set to nothing or ends by an
    /// error, which `failed` tells. It begins with the next frame; what was put in before is not for it.
    void setProgram(std::shared_ptr<ShowProgram> program);
    [[nodiscard]] const std::shared_ptr<ShowProgram>& program() const noexcept { return program_; }
    /// Whether the program that shows moves the servos, too; whoever takes them in the document sends it off them.
    void setProgramDrives(bool drives);
    /// A key or button (1 pressed, 0 released) or a number for the program that shows; each reaches it once.
    void input(const std::string& name, double value);
    /// The source has something else to show than when the loop came to rest.
    void refresh();
    using Tap = std::function<void(const MatchFrame&)>;
    /// Called in the loop's thread with every new frame, also while the window is stuck; must return at once.
    int addTap(Tap tap);
    /// When this returns, it is called no more.
    void removeTap(int id);

signals:
    /// A new frame, newest only: frames that come faster than the window takes them are left out.
    void framed();
    /// STOP was pressed, also where it holds already.
    void stopOrdered();
    void stoppedChanged();
    void dancingChanged();
    void posePlayChanged();
    void scenePlayingChanged();
    /// `driver` may be another now.
    void driverChanged();
    /// An edit took the servos: strokes, another driver or a new target. Not when a rig or a project is opened.
    void taken();
    /// The program that shows was given an input.
    void inputGiven(const QString& name, double value);
    void failed(const QString& why);

private:
    void onChanged(StateParts parts);
    void sendSoon();
    void send();
    void take();
    void takeError();
    void tap(); ///< in the loop's thread

    StudioDocument& document_;
    std::shared_ptr<const MatchFrame> frame_;
    bool stopped_ = false;
    bool dancing_ = false;
    std::shared_ptr<const PosePlay> posePlay_;
    bool tint_ = true;
    std::optional<double> seek_;
    bool scenePlaying_ = true;
    std::optional<double> sceneSeek_;
    std::shared_ptr<const PoseBoard> poses_;
    std::shared_ptr<FrameSource> source_;
    std::shared_ptr<ShowProgram> program_;
    bool programDrives_ = false;
    Driver documentDriver_ = Driver::target; ///< as the document said it last
    std::shared_ptr<ShowInputs> inputs_;     ///< of that program
    Microseconds programSince_{0};           ///< by the loop's clock; frames from before tell of the program before it
    double lightDelay_ = 0.0;
    Language language_ = Language::english;
    bool paused_ = false;
    bool sending_ = false;              ///< a wish goes out when the event loop comes round
    std::vector<std::int64_t> shownAt_; ///< when matched frames were handed over, milliseconds
    std::atomic<bool> posted_ = false;  ///< the window has been told of a frame that it did not take yet
    std::mutex tapping_;
    std::map<int, Tap> taps_;
    int nextTap_ = 1;
    QTimer errors_;
    std::unique_ptr<MatchThread> thread_;
};

} // namespace lumorph::studio
