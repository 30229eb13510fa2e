#include "core/geometry/model.h"
