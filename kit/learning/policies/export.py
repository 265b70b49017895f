"""Networks of torch as plain arrays (needs the extra ``learn``)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from torch import nn

from kit.learning.policies.policies import Activation, Chance, Layer, Lstm, Network, Singles


def network_of(model: Any) -> Network:
    """What decides the actions of a stable-baselines3 or sb3-contrib model. TypeError for a kind not known here."""
    policy = model.policy
    if hasattr(policy, "q_net"):
        return _network(policy.q_net.q_net)
    if hasattr(policy, "quantile_net"):
        return _averaged(_network(policy.quantile_net.quantile_net), policy.quantile_net.n_quantiles)
    if hasattr(policy, "mlp_extractor"):
        return _network(
            [*policy.mlp_extractor.policy_net, policy.action_net], getattr(policy, "lstm_actor", None)
        )
    if isinstance(policy.action_net, nn.Sequential):
        return _network(policy.action_net)
    raise TypeError(f"there is no way yet to write down a {type(policy).__name__}")


def chance_of(model: Any) -> Chance:
    """How the model draws its actions while it explores."""
    if hasattr(model, "temperature"):
        return Chance("softmax", float(model.temperature))
    if hasattr(model, "exploration_rate"):
        return Chance("epsilon", float(model.exploration_rate))
    return Chance("softmax") if hasattr(model.policy, "mlp_extractor") else Chance("epsilon", 0.0)


def _network(modules: Iterable[nn.Module], lstm: Any = None) -> Network:
    layers, activation = [], "tanh"
    names: dict[type[nn.Module], Activation] = {nn.Tanh: "tanh", nn.ReLU: "relu"}
    for module in modules:
        if isinstance(module, nn.Linear):
            bias = np.zeros(module.out_features, np.float32) if module.bias is None else _array(module.bias)
            layers.append(Layer(_array(module.weight).T.copy(), bias))
        elif type(module) in names:
            activation = names[type(module)]
    return Network(tuple(layers), "relu" if activation == "relu" else "tanh", _lstm(lstm))


def _lstm(lstm: Any) -> Lstm | None:
    if lstm is None:
        return None
    if lstm.num_layers != 1:
        raise TypeError("a memory of more than one layer cannot be written down")
    return Lstm(
        Layer(_array(lstm.weight_ih_l0).T.copy(), _array(lstm.bias_ih_l0)),
        Layer(_array(lstm.weight_hh_l0).T.copy(), _array(lstm.bias_hh_l0)),
    )


def _averaged(network: Network, quantiles: int) -> Network:
    """The mean of a value's quantiles is linear in the last layer, so that layer can give it at once."""
    last = network.layers[-1]
    weights = last.weights.reshape(len(last.weights), quantiles, -1).mean(axis=1)
    bias = last.bias.reshape(quantiles, -1).mean(axis=0)
    return Network((*network.layers[:-1], Layer(weights, bias)), network.activation)


def _array(parameter: Any) -> Singles:
    array: Singles = parameter.detach().cpu().numpy().astype(np.float32).copy()
    return array
