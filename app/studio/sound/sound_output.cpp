#include "app/studio/sound/sound_output.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>

#include <unistd.h>

#include <QAudioDevice>
#include <QAudioSink>
#include <QIODevice>
#include <QMediaDevices>
#include <QThread>
#include <QTimer>

namespace lumorph::studio {
namespace {

constexpr int kChannels = 2;
constexpr int kBytesAFrame = kChannels * static_cast<int>(sizeof(std::int16_t));
constexpr int kBufferMilliseconds = 60; ///< from what happens to what is heard
constexpr std::chrono::milliseconds kLook{1000};
constexpr int kSilentLooks = 10;                 ///< until the output is let go
constexpr unsigned long kEndMilliseconds = 1000; ///< that a thread gets to end

/// Qt 6.4 speaks PulseAudio (PipeWire answers as well), and complains on stderr where nobody does.
bool hasSoundServer() {
    if (!qEnvironmentVariableIsEmpty("PULSE_SERVER")) return true;
    std::filesystem::path folder = qEnvironmentVariable("PULSE_RUNTIME_PATH").toStdString();
    if (folder.empty()) {
        const std::string runtime = qEnvironmentVariable("XDG_RUNTIME_DIR").toStdString();
        folder = std::filesystem::path(runtime.empty() ? "/run/user/" + std::to_string(getuid()) : runtime) / "pulse";
    }
    std::error_code none;
    return std::filesystem::exists(folder / "native", none) || std::filesystem::exists("/usr/bin/pulseaudio", none);
}

/// Endless: what a sink pulls is what the mixer makes.
class MixedStream : public QIODevice {
public:
    explicit MixedStream(SoundMixer& mixer) : mixer_(mixer) { open(QIODevice::ReadOnly); }
    [[nodiscard]] bool isSequential() const override { return true; }
    [[nodiscard]] qint64 bytesAvailable() const override { return qint64(kSoundRate) * kBytesAFrame; }

protected:
    qint64 readData(char* data, qint64 most) override {
        const auto frames = std::min<std::size_t>(static_cast<std::size_t>(most) / kBytesAFrame, kSoundRate);
        samples_.resize(frames * kChannels);
        mixer_.mix(samples_);
        std::copy_n(reinterpret_cast<const char*>(samples_.data()), frames * kBytesAFrame, data);
        return static_cast<qint64>(frames * kBytesAFrame);
    }
    qint64 writeData(const char* /*data*/, qint64 /*size*/) override { return -1; }

private:
    SoundMixer& mixer_;
    std::vector<std::int16_t> samples_;
};

/// Lives in the sound's thread.
class SoundPlayer : public QObject {
public:
    SoundPlayer(std::shared_ptr<SoundMixer> mixer, std::shared_ptr<std::atomic<bool>> plays)
        : mixer_(std::move(mixer)), plays_(std::move(plays)) {}

    void begin() {
        mixer_->setBoard(std::make_shared<const SoundBoard>(SoundBoard::synthesised()));
        looks_ = std::make_unique<QTimer>();
        looks_->setInterval(kLook);
        connect(looks_.get(), &QTimer::timeout, this, [this] { look(); });
    }
    void end() {
        close();
        looks_.reset();
        devices_.reset();
    }
    /// Tries again at most once a look: a frame a sixtieth of a second asks for it.
    void wake() {
        looks_->start();
        silentLooks_ = 0;
        if (!sink_ && hasSoundServer()) open();
        plays_->store(true);
    }

private:
    void open() {
        if (!devices_) {
            devices_ = std::make_unique<QMediaDevices>();
            // The user has chosen another one, or it was unplugged.
            connect(devices_.get(), &QMediaDevices::audioOutputsChanged, this, [this] {
                if (sink_ && QMediaDevices::defaultAudioOutput() != device_) close();
            });
        }
        device_ = QMediaDevices::defaultAudioOutput();
        if (device_.isNull()) return;
        QAudioFormat format;
        format.setChannelCount(kChannels);
        format.setSampleFormat(QAudioFormat::Int16);
        format.setSampleRate(kSoundRate);
        if (!device_.isFormatSupported(format)) format.setSampleRate(44'100);
        if (!device_.isFormatSupported(format)) return;
        mixer_->setRate(format.sampleRate());
        mixer_->forgetFrames();
        sink_ = std::make_unique<QAudioSink>(device_, format);
        sink_->setBufferSize(format.bytesForDuration(kBufferMilliseconds * 1000));
        stream_ = std::make_unique<MixedStream>(*mixer_);
        sink_->start(stream_.get());
        if (sink_->error() != QAudio::NoError) close();
    }
    void close() {
        if (sink_) sink_->stop();
        sink_.reset();
        stream_.reset();
        plays_->store(false); // the next sound asks for it anew
    }
    void look() {
        const bool failed = sink_ && sink_->state() == QAudio::StoppedState;
        if (!sink_ || failed) mixer_->forget();
        silentLooks_ = mixer_->silent() ? silentLooks_ + 1 : 0;
        if (sink_ && !failed && silentLooks_ < kSilentLooks) return;
        close();
        looks_->stop();
    }

    std::shared_ptr<SoundMixer> mixer_;
    std::shared_ptr<std::atomic<bool>> plays_;
    std::unique_ptr<QTimer> looks_;
    std::unique_ptr<QMediaDevices> devices_;
    QAudioDevice device_;
    std::unique_ptr<QAudioSink> sink_;
    std::unique_ptr<MixedStream> stream_;
    int silentLooks_ = 0;
};

} // namespace

struct SoundOutput::Data {
    std::shared_ptr<std::atomic<bool>> plays = std::make_shared<std::atomic<bool>>(false);
    QThread* thread = new QThread;
    SoundPlayer* player = nullptr; ///< of that thread
};

SoundOutput::SoundOutput(std::shared_ptr<SoundMixer> mixer) : data_(std::make_unique<Data>()) {
    data_->player = new SoundPlayer(std::move(mixer), data_->plays);
    data_->player->moveToThread(data_->thread);
    QObject::connect(data_->thread, &QThread::started, data_->player, &SoundPlayer::begin);
    QObject::connect(
        data_->thread, &QThread::finished, data_->player,
        [player = data_->player] {
            player->end();
            player->deleteLater();
        },
        Qt::DirectConnection);
    data_->thread->setObjectName("sound");
    data_->thread->start(QThread::HighPriority);
}

SoundOutput::~SoundOutput() {
    data_->thread->quit();
    // One that a sound server holds up goes down with the program.
    if (data_->thread->wait(kEndMilliseconds)) delete data_->thread;
}

void SoundOutput::wake() {
    if (data_->plays->exchange(true)) return;
    QMetaObject::invokeMethod(data_->player, &SoundPlayer::wake, Qt::QueuedConnection);
}

} // namespace lumorph::studio
