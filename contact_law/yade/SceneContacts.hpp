// O.interactions and the fused engine's contacts: exported for YADE's recorders, for functors and for other runs, and taken from there by
// a run that starts.
#pragma once
#include "../engine/contacts.hpp"
#include "JKRWada.hpp"
#include "SceneGrains.hpp"
#include <algorithm>
#include <functional>
#include <string>

namespace yade {

/* Which JKRWadaEngine has the contacts of a scene, so that none are lost when a script puts other engines in its place. It stands in a
 * tag of the scene, O.tags["contacts"], which O.save keeps. */
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
	bool onlyInEngine() const { return isAny() && !isWritten(); }
	bool isWritten() const
	{
		const auto tag = std::find_if(scene.tags.begin(), scene.tags.end(), isHolder);
		return tag != scene.tags.end() && tag->find(also) != std::string::npos;
	}
	static constexpr const char* refusal =
	        "the contacts of these grains are in another JKRWadaEngine, which has not given way: call its "
	        "giveWay() or writeInteractions() first, or import contact_law before O.engines is set";

private:
	static constexpr const char *key = "contacts=", *also = ", O.interactions";
	static bool isHolder(const std::string& tag) { return tag.rfind(key, 0) == 0; }
	bool has(const std::string& tag) const { return std::find(scene.tags.begin(), scene.tags.end(), tag) != scene.tags.end(); }

	Scene& scene;
};

class SceneContacts {
public:
	/* The scene's contacts, for a run that starts: all of the moment of the bodies' positions. (The functors' are of a step before,
	 * which is left out of account: an error of first order in that step.) O.interactions are this object's afterwards. */
	contact_law::Inherited take(Scene&, const SceneGrains&, unsigned mechanisms);
	bool ofFunctors() const; // whether any that were taken are

	/* All contacts, in the order of their bodies' ids, as real interactions with ScGeom and JKRWadaPhys; those that have ended go.
	 * Interactions of contacts that continue stay the same objects. isThere: whether there is still a body of an id; contacts of
	 * those that are gone go too. */
	using IsThere = std::function<bool(int id)>;
	void write(Scene&, const contact_law::Dynamics&, const IsThere& isThere = {});

	// Empty, or that a script has erased some of what was written.
	std::string erased(const Scene&) const;

	// Empties O.interactions of what was written before and is no longer so; whether there was anything.
	bool withdraw(Scene&);

private:
	shared_ptr<Interaction> made(const Scene&, int id1, int id2, const contact_law::ContactNow&);

	std::vector<shared_ptr<Interaction>> held; // in O.interactions, by this engine, sorted
	SharedConstants constants;
	SharedBonds bonds;
};

} // namespace yade
