#!/usr/bin/env python3
"""Trains a small network for `--features learned` on recordings with ground truth, such as those of `liloc sim`.

train.py OUT --train RECORDING... --test RECORDING... [--steps N] [--minutes M]
OUT gets weights.safetensors, log.csv and checkpoint.pt; begun again with the same OUT it goes on where it ended, and ends at the
same weights as if it had not been interrupted: what step N learns from follows from the seed and N. Needs PyTorch and Pillow
(deploy/install --torch). Exit codes: 0 done, 1 failed or out of time, 2 bad usage or input.
"""
import argparse
import os
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

POSITIVES, CANDIDATES = 256, 1024  # a pair: points that are drawn closer, and those that the hardest are looked for among
NEAR, FAR = 0.1, 1.4               # as FCGF: squared distance of what is one, distance of what is not
SAME_VOXELS, OTHER_VOXELS = 1.0, 3.0  # so near, in voxels, two points are one; so far they are none
FEWEST = 64                        # pairs with fewer points in common teach nothing
INLIER_M = 0.2                     # a match so near is right, in figures


def correspondences(numpy, ceiling, device, within):
    """Rows of the device's points, and of the ceiling's nearest to each, where one is so near."""
    rows, nearest = [], []
    for begin in range(0, len(device), 256):
        squared = ((device[begin:begin + 256, None] - ceiling[None]) ** 2).sum(-1)
        best = squared.argmin(1)
        good = numpy.nonzero(squared[numpy.arange(len(best)), best] < within ** 2)[0]
        rows.append(begin + good)
        nearest.append(best[good])
    return numpy.concatenate(rows), numpy.concatenate(nearest)


class Sample:
    """A pair, each cloud turned at random about z, in voxels, and what is the same in both."""

    def __init__(self, numpy, sparse, pair, voxel_m, random):
        turn = []
        for _ in range(2):
            yaw = random.uniform(0, 2 * numpy.pi)
            R = numpy.array([[numpy.cos(yaw), -numpy.sin(yaw), 0], [numpy.sin(yaw), numpy.cos(yaw), 0], [0, 0, 1]])
            turn.append((R, random.uniform(-1, 1, 3)))
        (R_c, t_c), (R_d, t_d) = turn
        self.ceiling_voxels, ceiling = sparse.voxels_of(pair.ceiling @ R_c.T + t_c, voxel_m)
        self.device_voxels, device = sparse.voxels_of(pair.device @ R_d.T + t_d, voxel_m)
        # Both in the ceiling's own frame, as they lie in truth.
        self.ceiling = (ceiling - t_c) @ R_c
        self.device = (device - t_d) @ R_d @ pair.T_ceiling_device[:3, :3].T + pair.T_ceiling_device[:3, 3]
        self.device_rows, self.ceiling_rows = correspondences(numpy, self.ceiling, self.device, SAME_VOXELS * voxel_m)


def hardest_contrastive_loss(torch, sample, of_ceiling, of_device, voxel_m, random):
    """Choy, Park, Koltun 2019: what is one closer than NEAR, the nearest of what is not farther than FAR."""
    chosen = random.permutation(len(sample.device_rows))[:POSITIVES]
    rows = {"device": sample.device_rows[chosen], "ceiling": sample.ceiling_rows[chosen]}
    points, features = {"device": sample.device, "ceiling": sample.ceiling}, {"device": of_device, "ceiling": of_ceiling}
    apart = (features["device"][rows["device"]] - features["ceiling"][rows["ceiling"]]).pow(2).sum(1)
    loss = torch.relu(apart - NEAR).mean()
    for one, other in (("device", "ceiling"), ("ceiling", "device")):
        drawn = random.permutation(len(points[other]))[:CANDIDATES]
        distance_m = torch.cdist(torch.from_numpy(points[one][rows[one]]), torch.from_numpy(points[other][drawn]))
        unlike = (2 - 2 * features[one][rows[one]] @ features[other][drawn].T).clamp(min=1e-8).sqrt()
        hardest = unlike.masked_fill(distance_m < OTHER_VOXELS * voxel_m, 4.0).min(1).values
        loss = loss + 0.5 * torch.relu(FAR - hardest).pow(2).mean()
    return loss


class Trainer:
    def __init__(self, arguments):
        import numpy
        import torch

        import convert_fcgf
        from training import recordings, sparse_network
        self.numpy, self.torch, self.sparse, self.files = numpy, torch, sparse_network, convert_fcgf
        self.arguments = arguments
        torch.manual_seed(arguments.seed)
        torch.use_deterministic_algorithms(True)
        torch.set_num_threads(arguments.threads)
        self.network = sparse_network.Network(arguments.down, arguments.up, arguments.first_width, arguments.dimensions)
        self.optimizer = torch.optim.SGD(self.network.parameters(), lr=arguments.rate, momentum=0.8, weight_decay=1e-4)
        self.train = [recordings.Recording(root) for root in arguments.train]
        self.test = [recordings.Recording(root) for root in arguments.test]
        self.step, self.checkpoint = 0, arguments.out / "checkpoint.pt"
        self.settings = {key: str(value) for key, value in vars(arguments).items()
                         if key not in ("out", "minutes", "steps", "threads", "test")}

    def resume(self):
        if not self.checkpoint.exists():
            return
        state = self.torch.load(str(self.checkpoint))
        if state["settings"] != self.settings:
            raise ValueError(f"{self.checkpoint}: was trained with other options; give another OUT")
        self.network.load_state_dict(state["network"])
        self.optimizer.load_state_dict(state["optimizer"])
        self.step = state["step"]

    def save(self):
        state = {"settings": self.settings, "network": self.network.state_dict(),
                 "optimizer": self.optimizer.state_dict(), "step": self.step}
        self.torch.save(state, str(self.checkpoint) + ".new")
        os.replace(str(self.checkpoint) + ".new", self.checkpoint)
        arrays = {name: (list(value.shape), value.numpy().astype("<f4").tobytes())
                  for name, value in self.network.state_dict().items() if name.endswith(self.files.USED)}
        about = {"voxel_size_m": repr(self.arguments.voxel), "normalize": "true", "network": "small",
                 "trained": f"{self.step} steps, seed {self.arguments.seed}"}
        self.files.write_safetensors(self.arguments.out / "weights.safetensors", arrays, about)

    def sample(self, of, random):
        """Some moment's pair; None: too little in common."""
        recording = of[random.integers(len(of))]
        pair = recording.pair(random.integers(len(recording.moments)))
        if len(pair.ceiling) == 0 or len(pair.device) == 0:
            return None
        sample = Sample(self.numpy, self.sparse, pair, self.arguments.voxel, random)
        return sample if len(sample.device_rows) >= FEWEST else None

    def features(self, sample):
        return [self.network(self.network.maps(voxels)) for voxels in (sample.ceiling_voxels, sample.device_voxels)]

    def learn(self):
        random = self.numpy.random.default_rng([self.arguments.seed, self.step])
        for group in self.optimizer.param_groups:
            group["lr"] = self.arguments.rate * 0.1 ** (2 * self.step / self.arguments.steps)
        self.network.train()
        sample, loss = self.sample(self.train, random), None
        if sample is not None:
            loss = hardest_contrastive_loss(self.torch, sample, *self.features(sample), self.arguments.voxel, random)
            self.optimizer.zero_grad()
            loss.backward()
            self.torch.nn.utils.clip_grad_norm_(self.network.parameters(), 5.0)
            self.optimizer.step()
        self.step += 1
        return None if loss is None else loss.item()

    def figures(self):
        """Over so many held-out pairs: share of right matches, and of pairs of which over 5 % are right."""
        random, shares = self.numpy.random.default_rng([self.arguments.seed, 2**31]), []
        self.network.eval()
        with self.torch.no_grad():
            for _ in range(self.arguments.test_pairs):
                sample = self.sample(self.test, random)
                if sample is None:
                    continue
                of_ceiling, of_device = self.features(sample)
                match = (of_device @ of_ceiling.T).argmax(1).numpy()
                apart_m = self.numpy.linalg.norm(sample.device - sample.ceiling[match], axis=1)
                shares.append((apart_m[sample.device_rows] < INLIER_M).mean())
        shares = self.numpy.array(shares)
        return (shares.mean(), (shares > 0.05).mean()) if len(shares) else (0.0, 0.0)

    def run(self):
        self.arguments.out.mkdir(parents=True, exist_ok=True)
        self.resume()
        began, losses, log = time.monotonic(), [], self.arguments.out / "log.csv"
        if not log.exists():
            log.write_text("step,loss,right_matches,pairs_over_5_percent\n")
        while self.step < self.arguments.steps:
            loss = self.learn()
            losses += [] if loss is None else [loss]
            late = time.monotonic() - began > 60 * self.arguments.minutes
            if self.step % self.arguments.every == 0 or self.step == self.arguments.steps or late:
                right, pairs = self.figures() if self.test else (0.0, 0.0)
                mean = sum(losses) / max(1, len(losses))
                with log.open("a") as out:
                    out.write(f"{self.step},{mean:.4f},{right:.4f},{pairs:.4f}\n")
                print(f"step {self.step}: loss {mean:.3f}; held out: {100 * right:.1f} % of matches right, "
                      f"{100 * pairs:.0f} % of pairs over 5 %", flush=True)
                losses = []
                self.save()
            if late and self.step < self.arguments.steps:
                print(f"train: out of time at step {self.step} of {self.arguments.steps}; begun again it goes on", file=sys.stderr)
                return 1
        return 0


def channels(text):
    values = tuple(int(part) for part in text.split("-"))
    if not 2 <= len(values) <= 6 or min(values) < 1:
        raise argparse.ArgumentTypeError("give two to six numbers of channels, such as 8-16-32")
    return values


def parsed():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path, metavar="OUT", help="folder of the results, and of a run to go on with")
    parser.add_argument("--train", nargs="+", required=True, metavar="RECORDING", help="to learn from")
    parser.add_argument("--test", nargs="*", default=[], metavar="RECORDING", help="held out: figures alone")
    parser.add_argument("--steps", type=int, default=20000, help="pairs that are learned from (20000)")
    parser.add_argument("--minutes", type=float, default=180, help="it ends after so many, to be begun again (180)")
    parser.add_argument("--every", type=int, default=500, help="steps between figures and checkpoints (500)")
    parser.add_argument("--test-pairs", type=int, default=50, help="for the figures (50)")
    parser.add_argument("--voxel", type=float, default=0.1, help="size in metres (0.1)")
    parser.add_argument("--down", type=channels, default=(8, 16, 32), help="channels by level, finest first (8-16-32)")
    parser.add_argument("--up", type=channels, default=(16, 16, 16), help="on the way back, finest first (16-16-16)")
    parser.add_argument("--first-width", type=int, choices=(3, 5, 7), default=5, help="of the first kernel (5)")
    parser.add_argument("--dimensions", type=int, default=16, help="of descriptors (16)")
    parser.add_argument("--rate", type=float, default=0.1, help="of learning, at first; a hundredth at the end (0.1)")
    parser.add_argument("--seed", type=int, default=1, help="of all randomness (1)")
    parser.add_argument("--threads", type=int, default=2, help="of PyTorch; other numbers round differently (2)")
    arguments = parser.parse_args()
    if len(arguments.down) != len(arguments.up):
        parser.error("--down and --up have as many levels")
    if not 0.005 <= arguments.voxel <= 1:
        parser.error("--voxel is 0.005 to 1 m")
    if min(arguments.steps, arguments.every, arguments.test_pairs, arguments.threads, arguments.dimensions) < 1:
        parser.error("--steps, --every, --test-pairs, --threads and --dimensions are at least 1")
    return arguments


def main():
    arguments = parsed()
    try:
        trainer = Trainer(arguments)
    except ImportError as error:
        print(f"train: {error}; run deploy/install --torch", file=sys.stderr)
        return 1
    except (OSError, ValueError, KeyError) as error:
        print(f"train: no usable recording: {type(error).__name__}: {error}", file=sys.stderr)
        return 2
    try:
        return trainer.run()
    except (OSError, ValueError) as error:
        print(f"train: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
