#pragma once
// Furniture of world 2: round, thin, soft and large things that an office of world 1 has not. As furniture.hpp:
// each stands on z = 0, centred, its back towards +y.
#include "proto-tests/sim/site/furniture.hpp"

namespace liloc::sim {

[[nodiscard]] Furniture make_sofa(Random& random);         ///< rounded arms and back, one to three seats
[[nodiscard]] Furniture make_round_table(Random& random);  ///< on one foot, low or bar-high, with crockery
[[nodiscard]] Furniture make_stool(Random& random);        ///< round, on one foot
[[nodiscard]] Furniture make_pole(Random& random);         ///< coat rack, lamp or stand: thin and tall
[[nodiscard]] Furniture make_whiteboard(Random& random);   ///< on two feet, leaning
[[nodiscard]] Furniture make_door_leaf(Random& random);    ///< a door that stands open
[[nodiscard]] Furniture make_pallet_rack(Random& random, double height_m);  ///< open, deep, half full
[[nodiscard]] Furniture make_machine(Random& random);                       ///< a tank or a housing with pipes
[[nodiscard]] Furniture make_trolley(Random& random);                       ///< wire shelves on wheels
[[nodiscard]] Furniture make_column(Random& random, double height_m);       ///< round or square, with a plinth

}  // namespace liloc::sim
