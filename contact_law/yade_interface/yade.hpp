/* What the plugin sees of YADE: the declarations of this folder, or, where YADE_INCLUDE is set, YADE's own headers. Compiled once, and
 * included before every file that sees a YADE type: Boost and Eigen are nearly all of what the compiler has to read. */
#pragma once
#ifndef CONTACT_LAW_YADES_OWN_HEADERS
#include "scene.hpp"
#else
#include <lib/factory/ClassFactory.hpp>
// They register every class in every file that includes them, which makes the compiler write constructors, virtual tables and Python properties of
// all of them: half a minute a file. YADE's libraries have registered them.
#pragma push_macro("REGISTER_FACTORABLE")
#undef REGISTER_FACTORABLE
#define REGISTER_FACTORABLE(name)
#include <core/Dispatching.hpp>
#include <core/GlobalEngine.hpp>
#include <core/Interaction.hpp>
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <lib/serialization/Serializable.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/NormShearPhys.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/common/Wall.hpp>
#include <pkg/dem/ScGeom.hpp>
#pragma pop_macro("REGISTER_FACTORABLE")
#endif
