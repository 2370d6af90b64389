"""A24's collision with compressed aggregates in place of close-packed and extracted (CPE) ones."""
