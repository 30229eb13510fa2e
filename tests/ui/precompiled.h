#pragma once

#include "tests/precompiled.h"

#include "app/studio/precompiled.h"

#include <QSignalSpy>
#include <QTest>
