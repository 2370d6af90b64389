/* Which JKRWadaEngine has the contacts of a scene, so that none are lost when a script puts other engines in its place. It stands in a tag of
 * the scene, O.tags["contacts"], which O.save keeps. */
#pragma once
#include <core/Scene.hpp>
#include <algorithm>
#include <string>

namespace yade {

class ContactsHolder {
public:
	explicit ContactsHolder(Scene& scene_)
	        : scene(scene_)
	{
	}
	// `name` has them; written: O.interactions has them too.
	void set(const std::string& name, bool written)
	{
		clear();
		scene.tags.push_back(std::string(key) + name + (written ? also : ""));
	}
	void clear() { scene.tags.erase(std::remove_if(scene.tags.begin(), scene.tags.end(), isHolder), scene.tags.end()); }

	bool is(const std::string& name) const { return has(std::string(key) + name) || has(std::string(key) + name + also); }
	bool isAny() const { return std::any_of(scene.tags.begin(), scene.tags.end(), isHolder); }
	// Whether O.interactions lacks the contacts.
	bool onlyInEngine() const { return isAny() && !isWritten(); }
	bool isWritten() const
	{
		const auto tag = std::find_if(scene.tags.begin(), scene.tags.end(), isHolder);
		return tag != scene.tags.end() && tag->find(also) != std::string::npos;
	}
	static constexpr const char* refusal =
	        "the contacts of these grains are in another JKRWadaEngine, which has not given way: call its "
	        "giveWay() or handOver() first, or import contact_law before O.engines is set";

private:
	static constexpr const char *key = "contacts=", *also = ", O.interactions";
	static bool isHolder(const std::string& tag) { return tag.rfind(key, 0) == 0; }
	bool has(const std::string& tag) const { return std::find(scene.tags.begin(), scene.tags.end(), tag) != scene.tags.end(); }

	Scene& scene;
};

} // namespace yade
