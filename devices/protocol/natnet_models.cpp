#include <utility>

#include "devices/protocol/natnet.h"
#include "devices/protocol/natnet_bytes.h"

namespace lumorph::natnet {

namespace {

constexpr int kKinds = 7;
constexpr std::size_t kPlateCalibrationBytes = (2 + 3 + 12 * 12 + 4 * 3) * 4;

class ModelReader {
public:
    explicit ModelReader(Version version) : version_(version) {}

    [[nodiscard]] Model read(Bytes& in, Model::Kind kind) const {
        Model model;
        model.kind = kind;
        switch (kind) {
        case Model::Kind::markerSet:
            model.name = in.text();
            names(in, in.count(1), model.markers);
            break;
        case Model::Kind::rigidBody:
            model.bodies.push_back(body(in, model.markers));
            model.name = model.bodies.front().name;
            model.id = model.bodies.front().id;
            break;
        case Model::Kind::skeleton:
            model.name = in.text();
            model.id = in.take<std::int32_t>();
            bones(in, model);
            break;
        case Model::Kind::plate:
            plate(in, model);
            break;
        case Model::Kind::device:
            device(in, model);
            break;
        case Model::Kind::camera:
            model.name = in.text();
            in.skip(kVectorBytes + 16);
            break;
        case Model::Kind::asset:
            asset(in, model);
            break;
        }
        return model;
    }

private:
    static void names(Bytes& in, std::size_t n, std::vector<std::string>& names) {
        for (std::size_t i = 0; i < n; ++i) names.emplace_back(in.text());
    }

    Model::Body body(Bytes& in, std::vector<std::string>& markers) const {
        Model::Body body;
        body.name = in.text();
        body.id = in.take<std::int32_t>();
        body.parent = in.take<std::int32_t>();
        body.offset = in.vector();
        if (version_ < Version{3, 0}) return body;
        const std::size_t n = in.count(kVectorBytes + 4);
        in.skip(n * (kVectorBytes + 4)); // where its markers are, and their active labels
        if (version_ >= Version{4, 0}) names(in, n, markers);
        return body;
    }

    void bones(Bytes& in, Model& model) const {
        std::vector<std::string> ignored;
        for (std::size_t n = in.count(1 + 4 + 4 + kVectorBytes); n > 0; --n) {
            ignored.clear();
            model.bodies.push_back(body(in, ignored));
        }
    }

    static void channels(Bytes& in) {
        in.skip(4 + 4); // what kind of plate or device, what kind of data
        for (std::size_t n = in.count(1); n > 0; --n) (void)in.text();
    }

    static void plate(Bytes& in, Model& model) {
        model.id = in.take<std::int32_t>();
        model.name = in.text();
        in.skip(kPlateCalibrationBytes);
        channels(in);
    }

    static void device(Bytes& in, Model& model) {
        model.id = in.take<std::int32_t>();
        model.name = in.text();
        (void)in.text(); // serial number
        channels(in);
    }

    void asset(Bytes& in, Model& model) const {
        model.name = in.text();
        in.skip(4); // what kind of asset
        model.id = in.take<std::int32_t>();
        bones(in, model);
        for (std::size_t n = in.count(1 + 4 + kVectorBytes + 4 + 2); n > 0; --n) {
            model.markers.emplace_back(in.text());
            in.skip(4 + kVectorBytes + 4 + 2);
        }
    }

    Version version_;
};

} // namespace

std::vector<Model> readModels(std::span<const std::byte> payload, Version version) {
    const bool sized = version >= Version{4, 1};
    Bytes bytes(payload);
    std::vector<Model> models;
    const ModelReader reader(version);
    for (std::size_t n = bytes.count(sized ? 8 : 4); n > 0; --n) {
        const auto kind = bytes.take<std::int32_t>();
        const bool known = kind >= 0 && kind < kKinds;
        if (!sized) {
            if (!known) refusePacket("it describes something of the unknown kind " + std::to_string(kind));
            models.push_back(reader.read(bytes, static_cast<Model::Kind>(kind)));
            continue;
        }
        // Newer versions may say more of each than we know of.
        Bytes part(bytes.skip(bytes.take<std::uint32_t>()));
        if (known) models.push_back(reader.read(part, static_cast<Model::Kind>(kind)));
    }
    bytes.expectEnd("it");
    return models;
}

} // namespace lumorph::natnet
