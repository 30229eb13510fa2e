#include "core/loop/match_field.h"

#include <utility>

#include "core/base/error.h"
#include "core/rig/rig_file.h"

namespace lumorph {

namespace {

Rig rigOf(const Field& field) {
    Rig rig = readRigGlb(field.rigGlb, field.rigName);
    if (rig.actuatorCount() != field.actuators.size())
        throw DataError(field.rigName, "the field and the rig in it do not agree", "build the field again");
    return rig;
}

} // namespace

MatchField::MatchField(Field built)
    : field(std::move(built)), rig(rigOf(field)), coverage(rig, field.frame, field.levels), voting(field),
      relief(reliefRoom(field)) {}

bool isFieldOf(const MatchField& field, const Rig& rig) {
    // Numbers may change in their last bit by being written and read, so equal files count as well.
    return deformAlike(field.rig.parts(), rig.parts()) || writeRigGlb(rig) == field.field.rigGlb;
}

} // namespace lumorph
