#include "core/geometry/mesh_writers.h"

#include <memory>

#include <Model/COM/NMR_DLLInterfaces.h>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

struct Release {
    void operator()(NMR::PLib3MFBase* object) const noexcept { NMR::lib3mf_release(object); }
};
/// What lib3mf hands out; it counts references.
template <typename Object> using Handle = std::unique_ptr<Object, Release>;

void require(const std::string& name, LIB3MFRESULT result) {
    if (result < 0)
        throw InvalidInput("3MF of " + inQuotes(name), "lib3mf refuses it with error " + std::to_string(result),
                           "check whether the mesh is a closed solid");
}

/// Calls that make something give it by their last argument.
template <typename Object, typename Call> Handle<Object> made(const std::string& name, const Call& call) {
    Object* object = nullptr;
    require(name, call(&object));
    return Handle<Object>(object);
}

Handle<NMR::PLib3MFModelMeshObject> addMesh(NMR::PLib3MFModel* model, const TriangleMesh& mesh,
                                            const std::string& name) {
    auto object = made<NMR::PLib3MFModelMeshObject>(
        name, [&](auto** place) { return NMR::lib3mf_model_addmeshobject(model, place); });
    std::vector<NMR::MODELMESHVERTEX> vertices;
    for (const glm::vec3& p : mesh.positions) vertices.push_back({{p.x, p.y, p.z}});
    std::vector<NMR::MODELMESHTRIANGLE> triangles;
    for (const glm::uvec3& t : mesh.triangles) triangles.push_back({{t.x, t.y, t.z}});
    require(name, NMR::lib3mf_object_setnameutf8(object.get(), name.c_str()));
    require(name, NMR::lib3mf_meshobject_setgeometry(object.get(), vertices.data(), static_cast<DWORD>(vertices.size()),
                                                     triangles.data(), static_cast<DWORD>(triangles.size())));
    return object;
}

std::vector<std::byte> bytesOf(NMR::PLib3MFModel* model, const std::string& name) {
    const auto writer = made<NMR::PLib3MFModelWriter>(
        name, [&](auto** place) { return NMR::lib3mf_model_querywriter(model, "3mf", place); });
    ULONG64 size = 0;
    require(name, NMR::lib3mf_writer_getstreamsize(writer.get(), &size));
    std::vector<std::byte> bytes(size);
    require(name, NMR::lib3mf_writer_writetobuffer(writer.get(), reinterpret_cast<BYTE*>(bytes.data()), size));
    return bytes;
}

} // namespace

std::vector<std::byte> write3mf(const TriangleMesh& mesh, const std::string& name) {
    const auto model = made<NMR::PLib3MFModel>(name, [](auto** place) { return NMR::lib3mf_createmodel(place); });
    require(name, NMR::lib3mf_model_setunit(model.get(), NMR::MODELUNIT_MILLIMETER));
    const auto object = addMesh(model.get(), mesh, name);
    const auto item = made<NMR::PLib3MFModelBuildItem>(
        name, [&](auto** place) { return NMR::lib3mf_model_addbuilditem(model.get(), object.get(), nullptr, place); });
    return bytesOf(model.get(), name);
}

} // namespace lumorph
