// What this plugin is, as seen from Python; and the gate through which its classes reach YADE.
#pragma once
#include <lib/serialization/Serializable.hpp>

namespace yade {

class ContactLawPlugin : public Serializable {
public:
	static std::string commit();             // of the sources, "unknown" where git didn't know
	static std::string refusal();            // why the classes are not there; empty when they are
	static boost::python::list classNames(); // of the plugin's classes
	static boost::python::tuple channels();  // of energy: (name, "stored", "lost" or "work") each

	// YADE calls this when it takes a class to Python: the moment at which this plugin proves the layouts and lets its other classes in.
	void checkPyClassRegistersItself(const std::string& className) const override;
	virtual ~ContactLawPlugin() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(ContactLawPlugin, Serializable,
		"The plugin contact_law itself: the git commit it was built from, the names of its classes, its energy channels, and, when it refused to load them, the reason.",
		,
		,
		.add_static_property("commit", &ContactLawPlugin::commit)
		.add_static_property("refusal", &ContactLawPlugin::refusal)
		.add_static_property("classNames", &ContactLawPlugin::classNames)
		.add_static_property("channels", &ContactLawPlugin::channels)
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(ContactLawPlugin);

} // namespace yade
