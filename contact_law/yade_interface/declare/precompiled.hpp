// Compiled once, included before every file that sees a YADE type: Boost and Eigen are nearly all of what the compiler has to read.
#include <core/Omega.hpp>
#include <core/Interaction.hpp>
#include <core/Scene.hpp>
#include <lib/serialization/Serializable.hpp>
#include <core/Dispatching.hpp>
