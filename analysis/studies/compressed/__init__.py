"""The collision of Arakawa et al. (2024) with compressed aggregates in place of close-packed and extracted (CPE) ones."""
