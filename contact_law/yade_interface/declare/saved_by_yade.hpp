/* Saving a class saves its base first. The bases' own serialize functions are not exported by YADE's libraries; what is exported, for each base and each
   archive, are the functions one layer up, oserializer::save_object_data and iserializer::load_object_data: exactly those are linked to.
   ("extern template class" would claim more than is exported, and fail to link without optimisation.) */
#pragma once
#include <lib/factory/ClassFactory.hpp>

// in the class
#define SAVED_BY_YADE_MEMBER                                                                                                               \
private:                                                                                                                                   \
	friend class boost::serialization::access;                                                                                         \
	template <class Archive> void serialize(Archive&, unsigned int);

#define SAVED_BY_YADE_ARCHIVE_(format, Class)                                                                                              \
	extern template void boost::archive::detail::oserializer<boost::archive::BOOST_PP_CAT(format, _oarchive),                          \
	        yade::Class>::save_object_data(boost::archive::detail::basic_oarchive&, const void*) const;                                \
	extern template void boost::archive::detail::iserializer<boost::archive::BOOST_PP_CAT(format, _iarchive),                          \
	        yade::Class>::load_object_data(boost::archive::detail::basic_iarchive&, void*, unsigned int) const;

// after the class, outside of every namespace
#define SAVED_BY_YADE(Class)                                                                                                               \
	BOOST_CLASS_EXPORT_KEY(yade::Class)                                                                                                \
	SAVED_BY_YADE_ARCHIVE_(xml, Class)                                                                                                 \
	SAVED_BY_YADE_ARCHIVE_(binary, Class)
