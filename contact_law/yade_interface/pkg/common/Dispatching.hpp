#pragma once
#pragma message "YADE 2023.02a has this file as core/Dispatching.hpp: include that one"
#include <core/Dispatching.hpp>
