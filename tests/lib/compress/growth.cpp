// Growing partitions for a goal: forgetting changes no tree, the parts that are kept are bounded by what the goal
// can use, and the size of a tree is known before it is made.
#include "tests/inputs/sanitized.h"
#include "tests/inputs/synthetic.h"

#include "compress/fit/partition.h"
#include "compress/fit/prune.h"
#include "compress/fit/tree.h"
#include "compress/fit/tree_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace acdf::compress;

constexpr double kNoBound = std::numeric_limits<double>::infinity();
constexpr std::size_t kFew = 256;
/// Sanitized, the last steps, which take longest, are left out.
const int kSteps = acdf_test::kSanitized ? 6 : 9;

Target noise() { return acdf_test::noise_target(256, 200, 5); }

/// Dim noise with lights in it, some of them side by side.
Target lights() {
    Target target = acdf_test::noise_target(200, 130, 7);
    for (std::size_t i = 0; i < target.values.size(); i += 997) target.values[i] = 1e5f;
    for (std::size_t i = 5000; i < 5040; ++i) target.values[i] = 3e3f;
    target.total = integral(target);
    target.mean_square = target.total * target.total;
    return target;
}

Partition partition_of(const Target& target) { return Partition(grid_of(target), integral(target)); }

Cascade pruned_cascade(const Partition& partition, double price, double heaviest = kNoBound) {
    Flattened flat;
    flatten(partition, prune(partition.parts(), price, heaviest), flat);
    return flat.cascade;
}

void expect_equal(const Cascade& a, const Cascade& b) {
    ASSERT_EQ(a.curves.size(), b.curves.size());
    for (std::size_t i = 0; i < a.curves.size(); ++i) {
        EXPECT_EQ(a.curves[i].axis, b.curves[i].axis);
        EXPECT_EQ(a.curves[i].knots, b.curves[i].knots);
        EXPECT_EQ(a.curves[i].probability, b.curves[i].probability); // to the last bit
        EXPECT_EQ(a.curves[i].children, b.curves[i].children);
    }
}

TEST(PartitionGrowth, WhatIsForgottenChangesNoTreeAndNoNews) {
    for (const Target& target : {noise(), lights()}) {
        Partition whole = partition_of(target), forgetful = partition_of(target);
        double finest = 1e-2;
        std::size_t before = 1;
        for (int step = 0; step < kSteps; ++step, finest *= 0.25) {
            SCOPED_TRACE(finest);
            const double price = finest / kLeastBytes;
            const bool news = whole.refine(finest, kNoBound);
            EXPECT_EQ(news, whole.parts().size() > before);
            EXPECT_EQ(forgetful.refine(finest, kNoBound, {price, kFew}), news);
            EXPECT_LE(forgetful.parts().size(), whole.parts().size());
            before = whole.parts().size();
            for (const double above : {1.0, 1.3, 7.0, 300.0})
                expect_equal(pruned_cascade(whole, above * price), pruned_cascade(forgetful, above * price));
        }
        forgetful.forget(finest * 4.0 / kLeastBytes, kNoBound);
        expect_equal(pruned_cascade(whole, finest * 4.0), pruned_cascade(forgetful, finest * 4.0));
    }
}

TEST(PartitionGrowth, WhatABoundOnWeightsNeedsIsNotForgotten) {
    ACDF_NOT_SANITIZED();
    const double heaviest = 2.0;
    for (const Target& target : {noise(), lights()}) {
        Partition whole = partition_of(target), forgetful = partition_of(target);
        bool bound = false, fewer = false;
        double finest = 1e-2;
        for (int step = 0; step < kSteps; ++step, finest *= 0.25) {
            SCOPED_TRACE(finest);
            const double price = finest / kLeastBytes;
            whole.refine(finest, heaviest);
            forgetful.refine(finest, heaviest, {price, kFew});
            fewer = fewer || forgetful.parts().size() < whole.parts().size();
            for (const double above : {1.0, 1.3, 7.0, 300.0}) {
                const Cascade wanted = pruned_cascade(whole, above * price, heaviest);
                expect_equal(wanted, pruned_cascade(forgetful, above * price, heaviest));
                bound = bound || wanted.curves.size() > pruned_cascade(whole, above * price).curves.size();
            }
        }
        EXPECT_TRUE(bound); // else the same as without
        EXPECT_TRUE(fewer);
    }
}

/// Faint noise divides into far more parts than pay.
TEST(PartitionGrowth, KeepsNoMoreThanTheGoalCanUse) {
    Target target = noise();
    for (float& value : target.values) value = 1.0f + 0.2f * std::fmod(value * 7919.0f, 1.0f);
    Partition whole = partition_of(target), forgetful = partition_of(target);
    bool far_fewer = false;
    for (double finest = 1e-2; finest > 1e-7; finest *= 0.25) {
        SCOPED_TRACE(finest);
        const double price = finest / kLeastBytes;
        whole.refine(finest, kNoBound);
        forgetful.refine(finest, kNoBound, {price, kFew});
        const std::size_t cells = prune(whole.parts(), price, kNoBound).cells[0];
        EXPECT_LE(forgetful.parts().size(), 16 * kFew + 4 * cells);
        far_fewer = far_fewer || whole.parts().size() > 8 * forgetful.parts().size();
    }
    EXPECT_TRUE(far_fewer);
}

TEST(PartitionGrowth, AForcedFirstSplitSurvivesForgetting) {
    const Target target = noise();
    for (const std::int8_t axis : {std::int8_t{0}, std::int8_t{1}}) {
        Partition whole(grid_of(target), integral(target), axis),
            forgetful(grid_of(target), integral(target), axis);
        for (double finest = 1e-2; finest > 1e-6; finest *= 0.25) {
            whole.refine(finest, kNoBound);
            forgetful.refine(finest, kNoBound, {finest / kLeastBytes, 0});
            expect_equal(pruned_cascade(whole, finest / kLeastBytes),
                         pruned_cascade(forgetful, finest / kLeastBytes));
        }
        EXPECT_EQ(whole.parts().front().split, axis);
    }
}

TEST(PartitionGrowth, GivesUpWhereThereAreTooManyParts) {
    const Target target = noise();
    Partition whole = partition_of(target), bounded = partition_of(target);
    constexpr std::size_t kMost = 6000;
    const double fine = 1e-8, coarse = 1e-3;
    whole.refine(coarse, kNoBound);
    ASSERT_LT(whole.parts().size(), kMost);
    bounded.refine(fine, kNoBound, {fine / kLeastBytes, kFew, kMost});
    EXPECT_TRUE(bounded.full());
    // What is divided at once: subtrees of half of the grid each, at most, of two parts a step.
    EXPECT_LT(bounded.parts().size(), kMost + 2 * target.values.size());
    bounded.forget(coarse / kLeastBytes, kNoBound);
    bounded.refine(coarse, kNoBound, {coarse / kLeastBytes, kFew, kMost});
    EXPECT_FALSE(bounded.full());
    expect_equal(pruned_cascade(whole, coarse), pruned_cascade(bounded, coarse));
}

/// A goal that no file within the bound reaches ends in a message; one that does makes the same bytes as without.
TEST(PartitionGrowth, AVarianceIsSearchedForWithinABoundOfBytes) {
    if (acdf_test::kSanitized) GTEST_SKIP() << "test_build_local searches for a smaller one";
    const Target target = acdf_test::noise_target(512, 400, 5);
    FitOptions options;
    options.goal.kind = Goal::Kind::variance;
    const auto bytes = [&](double variance, std::uint64_t most) {
        options.goal.variance = variance;
        options.most_bytes = most;
        return fit_trees({grid_of(target)}, options).tree.bytes;
    };
    constexpr std::uint64_t kMost = 200000;
    const std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
    const double least = 0.1, coarse = 0.25;
    try {
        bytes(least, kMost);
        ADD_FAILURE() << "a file beyond the bound";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("give a budget"), std::string::npos) << error.what();
    }
    EXPECT_EQ(bytes(coarse, kMost), bytes(coarse, none));
    const std::size_t near = bytes(0.22, kMost).size(); // found between the steps of the growth
    EXPECT_GT(near, kMost / 2);
    EXPECT_LT(near, 2 * kMost);
}

/// Bins that are pruned at one price, one of them dark.
struct Bins {
    std::vector<Partition> partitions;
    std::vector<PruneNodes> nodes;
    std::vector<std::vector<std::uint32_t>> begins;
    std::vector<Pruned> pruned;

    Bins(const std::vector<Target>& targets, double finest) {
        for (const Target& target : targets) {
            partitions.push_back(partition_of(target));
            partitions.back().refine(finest, kNoBound);
            nodes.push_back(prune_nodes(partitions.back().parts(), kNoBound));
            begins.push_back(begins_of(partitions.back().parts()));
        }
        nodes.emplace_back();
        begins.emplace_back();
    }
    std::vector<PrunedBin> at(double price) {
        pruned.clear();
        for (const PruneNodes& n : nodes) pruned.push_back(prune(n, price));
        std::vector<PrunedBin> out;
        for (std::size_t b = 0; b < nodes.size(); ++b) out.push_back({&nodes[b], &begins[b], &pruned[b]});
        return out;
    }
    Cascade cascade() const {
        Flattened flat;
        for (std::size_t b = 0; b < partitions.size(); ++b) flatten(partitions[b], pruned[b], flat);
        flatten_nothing(0, flat);
        return flat.cascade;
    }
};

TEST(TreeSizer, PredictsTheBytesThatEncodingMakes) {
    ACDF_NOT_SANITIZED();
    const std::vector<Target> targets{noise(), lights()};
    for (const double most_ratio : {kNoBound, 1.01}) {
        Bins bins(targets, 1e-7);
        TreeSizer sizer(3, most_ratio);
        SizedTree last;
        for (double price = 1e-2; price > 4e-8; price *= 0.7) {
            SCOPED_TRACE(price);
            const std::vector<PrunedBin> pruned = bins.at(price);
            const SizedTree tree = sizer.tree(pruned, price, {&last});
            const std::size_t bytes = sizer.bytes(tree);
            EXPECT_EQ(bytes, encode_tree(bins.cascade(), price, most_ratio).bytes.size());
            last = tree;
            // At another price the same curves may have other widths, and only then another size.
            const SizedTree cheaper = sizer.tree(pruned, 0.1 * price, {&last});
            EXPECT_EQ(cheaper.curves, tree.curves);
            EXPECT_EQ(sizer.bytes(cheaper), encode_tree(bins.cascade(), 0.1 * price, most_ratio).bytes.size());
            EXPECT_EQ(cheaper == tree, cheaper.widths == tree.widths);
        }
    }
}

/// The search for a budget is the same whether sizes are counted or every file is made.
TEST(TreeSizer, CountingFindsTheTreeThatMakingFinds) {
    const Target target = lights();
    for (const std::uint64_t budget : {500u, 3000u, 20000u, 100000u}) {
        if (acdf_test::kSanitized && budget > 20000) continue;
        FitOptions options;
        options.goal.kind = Goal::Kind::budget;
        options.goal.budget = budget;
        options.file_size = [](const EncodedTree& tree) { return std::uint64_t{tree.bytes.size() + 100}; };
        const EncodedTree made = fit_trees({grid_of(target)}, options).tree;
        options.size_by_length = true;
        EXPECT_EQ(fit_trees({grid_of(target)}, options).tree.bytes, made.bytes);
        EXPECT_LE(made.bytes.size() + 100, budget);
    }
}

} // namespace
