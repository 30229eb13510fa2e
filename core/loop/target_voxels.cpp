#include "core/loop/target_voxels.h"

namespace lumorph {

void TargetVoxels::keepDomain(const std::shared_ptr<const MatchField>& field) {
    bits_ &= field->coverage.domain();
    count_ = bits_.count();
    if (reachableOf_ != field) reachable_ = reachableVoxels(field->field);
    reachableOf_ = field;
    const std::size_t reached = bits_.countAnd(reachable_);
    shareUnreachable_ = count_ == 0 ? 0.0 : static_cast<double>(count_ - reached) / static_cast<double>(count_);
}

} // namespace lumorph
