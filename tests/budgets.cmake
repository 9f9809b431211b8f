# What the variance fit reaches on real probes.
if(TARGET acdf_input)
    acdf_add_test(test_budgets COST 30 SOURCES budgets.cpp LIBRARIES acdf_measure acdf_compress acdf_input)
endif()
