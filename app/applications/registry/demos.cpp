#include "app/applications/registry/demos.h"

#include <algorithm>
#include <vector>

#include "app/applications/ambient/ambient.h"
#include "app/applications/field/field_demo.h"
#include "app/applications/labyrinth/labyrinth.h"
#include "app/applications/techniques/techniques.h"
#include "app/applications/water/water.h"
#include "core/base/error.h"

namespace lumorph {

std::span<const Demo> demos() {
    static const std::vector<Demo> all{waterDemo(), techniquesDemo(), fieldDemo(), labyrinth::labyrinthDemo(),
                                       ambient::ambientDemo()};
    return all;
}

const Demo& demoNamed(const std::string& name) {
    const auto found = std::ranges::find(demos(), name, &Demo::name);
    if (found == demos().end())
        throw InvalidInput("demo '" + name + "'", "there is none of that name", "choose one of " + demoNames());
    return *found;
}

std::string demoNames() {
    std::string names;
    for (const Demo& demo : demos()) names += (names.empty() ? "" : ", ") + demo.name;
    return names;
}

} // namespace lumorph
