#include "app/output/sound_track.h"

#include <algorithm>
#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr int kBitRate = 160'000; ///< a second

// Each of libav's objects has a function of its own that frees it.
struct CloseInput {
    void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
};
struct CloseOutput {
    void operator()(AVFormatContext* context) const {
        avio_closep(&context->pb);
        avformat_free_context(context);
    }
};
struct FreeEncoder {
    void operator()(AVCodecContext* encoder) const { avcodec_free_context(&encoder); }
};
struct FreePacket {
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct FreeFrame {
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};

/// Gives back what libav says unless it is an error.
int checked(int answer, const char* what) {
    if (answer >= 0) return answer;
    char reason[AV_ERROR_MAX_STRING_SIZE] = {};
    av_strerror(answer, reason, sizeof reason);
    throw DeviceError("sound of the video", std::string(what) + ": " + reason,
                      "free some disk space, or install the package libavcodec59");
}

std::unique_ptr<AVFormatContext, CloseInput> openedVideo(const std::string& file) {
    AVFormatContext* context = nullptr;
    checked(avformat_open_input(&context, ("file:" + file).c_str(), nullptr, nullptr), "its pictures cannot be read");
    std::unique_ptr<AVFormatContext, CloseInput> video(context);
    checked(avformat_find_stream_info(context, nullptr), "its pictures cannot be read");
    return video;
}

std::unique_ptr<AVCodecContext, FreeEncoder> openedEncoder(int rate, bool headerOnce) {
    const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_AAC);
    std::unique_ptr<AVCodecContext, FreeEncoder> encoder(codec ? avcodec_alloc_context3(codec) : nullptr);
    if (!encoder) checked(AVERROR_ENCODER_NOT_FOUND, "it cannot be encoded");
    encoder->sample_fmt = AV_SAMPLE_FMT_FLTP;
    encoder->sample_rate = rate;
    encoder->bit_rate = kBitRate;
    encoder->time_base = {1, rate};
    av_channel_layout_default(&encoder->ch_layout, 2);
    if (headerOnce) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    checked(avcodec_open2(encoder.get(), codec, nullptr), "it cannot be encoded");
    return encoder;
}

/// The sound of a file that is being written.
class SoundTrack {
public:
    SoundTrack(AVFormatContext& out, AVCodecContext& encoder, std::span<const std::int16_t> samples)
        : out_(out), encoder_(encoder), samples_(samples), frame_(av_frame_alloc()), packet_(av_packet_alloc()) {}

    /// Goes on up to a time in seconds.
    void writeUpTo(double seconds) {
        while (begun_ < std::ssize(samples_) / 2 && static_cast<double>(begun_) < seconds * encoder_.sample_rate) {
            fillFrame();
            encode(frame_.get());
        }
    }
    void finish() { encode(nullptr); }

private:
    void fillFrame() {
        av_frame_unref(frame_.get());
        const auto left = std::ssize(samples_) / 2 - begun_;
        frame_->nb_samples = static_cast<int>(std::min<std::ptrdiff_t>(left, encoder_.frame_size));
        frame_->format = encoder_.sample_fmt;
        frame_->sample_rate = encoder_.sample_rate;
        frame_->pts = begun_;
        checked(av_channel_layout_copy(&frame_->ch_layout, &encoder_.ch_layout), "it cannot be encoded");
        checked(av_frame_get_buffer(frame_.get(), 0), "it cannot be encoded");
        for (int channel = 0; channel < 2; ++channel) {
            auto* plane = reinterpret_cast<float*>(frame_->extended_data[channel]);
            for (int k = 0; k < frame_->nb_samples; ++k)
                plane[k] =
                    static_cast<float>(samples_[static_cast<std::size_t>(2 * (begun_ + k) + channel)]) / 32768.0F;
        }
        begun_ += frame_->nb_samples;
    }

    /// Null: there are no more.
    void encode(AVFrame* frame) {
        checked(avcodec_send_frame(&encoder_, frame), "it cannot be encoded");
        for (;;) {
            const int answer = avcodec_receive_packet(&encoder_, packet_.get());
            if (answer == AVERROR(EAGAIN) || answer == AVERROR_EOF) return;
            checked(answer, "it cannot be encoded");
            const AVStream& stream = *out_.streams[1];
            av_packet_rescale_ts(packet_.get(), encoder_.time_base, stream.time_base);
            packet_->stream_index = stream.index;
            checked(av_interleaved_write_frame(&out_, packet_.get()), "it cannot be written");
        }
    }

    AVFormatContext& out_;
    AVCodecContext& encoder_;
    std::span<const std::int16_t> samples_;
    std::unique_ptr<AVFrame, FreeFrame> frame_;
    std::unique_ptr<AVPacket, FreePacket> packet_;
    std::ptrdiff_t begun_ = 0; ///< of each channel
};

} // namespace

void addSoundTrack(const std::string& video, std::span<const std::int16_t> samples, int rate, const std::string& into) {
    const auto in = openedVideo(video);
    const int pictures = checked(av_find_best_stream(in.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0), "it has none");
    AVFormatContext* context = nullptr;
    checked(avformat_alloc_output_context2(&context, nullptr, "mp4", nullptr), "it cannot be written");
    const std::unique_ptr<AVFormatContext, CloseOutput> out(context);
    const auto encoder = openedEncoder(rate, (out->oformat->flags & AVFMT_GLOBALHEADER) != 0);

    const AVStream& from = *in->streams[pictures];
    AVStream* shown = avformat_new_stream(out.get(), nullptr);
    AVStream* heard = avformat_new_stream(out.get(), nullptr);
    if (shown == nullptr || heard == nullptr) checked(AVERROR(ENOMEM), "it cannot be written");
    checked(avcodec_parameters_copy(shown->codecpar, from.codecpar), "it cannot be written");
    shown->codecpar->codec_tag = 0; // the container chooses it
    shown->time_base = from.time_base;
    shown->avg_frame_rate = from.avg_frame_rate;
    checked(avcodec_parameters_from_context(heard->codecpar, encoder.get()), "it cannot be written");
    heard->time_base = encoder->time_base;
    checked(avio_open(&out->pb, ("file:" + into).c_str(), AVIO_FLAG_WRITE), "it cannot be written");
    checked(avformat_write_header(out.get(), nullptr), "it cannot be written");

    SoundTrack track(*out, *encoder, samples);
    const std::unique_ptr<AVPacket, FreePacket> packet(av_packet_alloc());
    while (av_read_frame(in.get(), packet.get()) >= 0) {
        if (packet->stream_index == pictures) {
            track.writeUpTo(static_cast<double>(packet->pts) * av_q2d(from.time_base));
            packet->stream_index = shown->index;
            av_packet_rescale_ts(packet.get(), from.time_base, shown->time_base);
            checked(av_interleaved_write_frame(out.get(), packet.get()), "it cannot be written");
        }
        av_packet_unref(packet.get());
    }
    track.writeUpTo(1e9);
    track.finish();
    checked(av_write_trailer(out.get()), "it cannot be written");
}

} // namespace lumorph
