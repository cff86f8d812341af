#include "tools/bench_src/config.h"

#include "tools/bench_src/cpu.h"

namespace plumb::bench {
namespace {

constexpr BuildQuality qualities[] = {BuildQuality::fast, BuildQuality::medium, BuildQuality::high};

std::string operator/(std::string_view folder, std::string_view name) {
    return std::string(folder) + "/" + std::string(name);
}

void add_naive(std::vector<Config>& configs) {
    for (const TriangleTest test : {TriangleTest::watertight, TriangleTest::moeller_trumbore}) {
        const bool watertight = test == TriangleTest::watertight;
        Config config;
        config.structure.accel = AccelKind::naive;
        config.structure.build.triangle_test = test;
        config.structure.build.threads = 1; // whatever is asked
        config.structure.name = config.name = watertight ? "naive" : "naive/mt";
        config.by_default = watertight;
        configs.push_back(config);
    }
}

void add_sah(std::vector<Config>& configs, int threads) {
    const std::vector<Isa> isas = supported_isas();
    for (const BuildQuality quality : qualities)
        for (const Isa isa : isas)
            for (const TriangleTest test :
                 {TriangleTest::watertight, TriangleTest::moeller_trumbore}) {
                const bool watertight = test == TriangleTest::watertight;
                Config config;
                config.structure.build = {test, quality, isa, threads};
                config.structure.name = "sah" / (name_of(quality) / name_of(isa));
                if (!watertight)
                    config.structure.name += "/mt";
                config.name = config.structure.name;
                config.by_default =
                    watertight && isa == isas.back() && quality != BuildQuality::fast;
                configs.push_back(config);
                config.name += "/stream";
                config.wide = true;
                configs.push_back(config);
            }
}

void add_embree(std::vector<Config>& configs, int threads) {
    for (const bool robust : {false, true})
        for (const BuildQuality quality : qualities) {
            Config config;
            config.structure.accel = AccelKind::embree;
            config.structure.embree = {robust, quality, 1, threads};
            config.structure.name = "embree" / (name_of(quality) / (robust ? "robust" : "default"));
            config.name = config.structure.name;
            config.by_default = quality != BuildQuality::fast;
            configs.push_back(config);
            config.name += "/packet16";
            config.wide = true;
            configs.push_back(config);
        }
}

void add_cuda(std::vector<Config>& configs, RaySide side, int threads) {
    for (const CudaTree tree : {CudaTree::binary, CudaTree::wide}) {
        Config config;
        config.structure.cuda = tree;
        config.structure.side = side;
        config.structure.build.threads = threads;
        config.structure.name =
            std::string_view(side == RaySide::device ? "cuda" : "cuda-host") / name_of(tree);
        config.name = config.structure.name;
        config.by_default = true;
        configs.push_back(config);
    }
}

} // namespace

std::vector<Config> all_configs(int threads, std::optional<RaySide> side) {
    std::vector<Config> configs;
    add_embree(configs, threads);
    add_sah(configs, threads);
    add_naive(configs);
    if (side)
        add_cuda(configs, *side, threads);
    return configs;
}

bool matches_glob(std::string_view pattern, std::string_view text) {
    if (pattern.empty())
        return text.empty();
    if (pattern.front() == '*')
        return matches_glob(pattern.substr(1), text) ||
               (!text.empty() && matches_glob(pattern, text.substr(1)));
    return !text.empty() && pattern.front() == text.front() &&
           matches_glob(pattern.substr(1), text.substr(1));
}

} // namespace plumb::bench
