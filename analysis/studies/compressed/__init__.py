"""The same collision with CPE aggregates and with spheres cut out of compressed cells (Oshiro et al. 2025): was CPE a fair
stand-in in A24?"""
