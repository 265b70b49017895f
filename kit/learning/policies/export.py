"""Networks of torch as plain arrays (needs the extra ``learn``)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from torch import nn

from kit.arrays import Float32Array
from kit.learning.policies.policy import ActionSampling
from kit.learning.policies.policy_network import Activation, LinearLayer, LstmLayer, PolicyNetwork


def export_network(model: Any) -> PolicyNetwork:
    """Converts the network that chooses a stable-baselines3 or sb3-contrib model's actions. TypeError for an unknown kind."""
    policy = model.policy
    if hasattr(policy, "q_net"):
        return convert_modules(policy.q_net.q_net)
    if hasattr(policy, "quantile_net"):
        return _average_quantiles(
            convert_modules(policy.quantile_net.quantile_net), policy.quantile_net.n_quantiles
        )
    if hasattr(policy, "actor") and hasattr(policy.actor, "latent_pi"):
        actor = policy.actor
        means, log_deviations = (
            convert_modules([*actor.latent_pi, head]) for head in (actor.mu, actor.log_std)
        )
        return _join_heads(means, log_deviations)
    if hasattr(policy, "actor") and hasattr(policy.actor, "mu"):
        return convert_modules(policy.actor.mu)  # its tanh at the end is not among the layers
    if hasattr(policy, "mlp_extractor"):
        return convert_modules(
            [*policy.mlp_extractor.policy_net, policy.action_net], getattr(policy, "lstm_actor", None)
        )
    if isinstance(policy.action_net, nn.Sequential):
        return convert_modules(policy.action_net)
    raise TypeError(f"a {type(policy).__name__} cannot be exported yet")


def export_critic(model: Any) -> PolicyNetwork | None:
    """Converts the critic, the network that predicts the return of an observation, or of one with an action; None where the
    model has none, or one with a memory."""
    policy = model.policy
    if hasattr(policy, "mlp_extractor") and getattr(policy, "lstm_actor", None) is None:
        return convert_modules([*policy.mlp_extractor.value_net, policy.value_net])
    critic: Any = getattr(policy, "critic", None)
    if critic is None:
        return None
    first = convert_modules(critic.q_networks[0])
    return _average_quantiles(first, critic.n_quantiles) if hasattr(critic, "n_quantiles") else first


def export_sampling(model: Any) -> ActionSampling:
    """Converts how the model draws its actions while it explores."""
    actor = getattr(model.policy, "actor", None)
    if hasattr(actor, "latent_pi"):
        return ActionSampling("tanh-normal")
    if actor is not None:
        noise = getattr(model.action_noise, "base_noise", model.action_noise)
        deviations = np.zeros(model.action_space.shape) if noise is None else noise._sigma
        return ActionSampling("noisy-tanh", 1.0, tuple(np.asarray(deviations, dtype=float).tolist()))
    if hasattr(model.policy, "log_std"):
        deviations = model.policy.log_std.detach().exp().cpu().numpy().astype(float)
        return ActionSampling("normal", 1.0, tuple(deviations.tolist()))
    if hasattr(model, "temperature"):
        return ActionSampling("softmax", float(model.temperature))
    if hasattr(model, "exploration_rate"):
        return ActionSampling("epsilon", float(model.exploration_rate))
    return (
        ActionSampling("softmax")
        if hasattr(model.policy, "mlp_extractor")
        else ActionSampling("epsilon", 0.0)
    )


def convert_modules(modules: Iterable[nn.Module], lstm: Any = None) -> PolicyNetwork:
    """Converts modules layer by layer. A normalisation of what goes into a layer becomes a part of that layer."""
    layers: list[LinearLayer] = []
    activations: list[Activation] = []
    names: dict[type[nn.Module], Activation] = {nn.Tanh: "tanh", nn.ReLU: "relu"}
    normalisation: Any = None
    for module in modules:
        if isinstance(module, nn.Linear):
            layers.append(_convert_linear(module, normalisation))
            normalisation = None
        elif type(module) in names:
            activations.append(names[type(module)])
        elif hasattr(module, "ra_mean"):
            normalisation = module
    return PolicyNetwork(tuple(layers), activations[0] if activations else "tanh", _convert_lstm(lstm))


def _convert_linear(module: nn.Linear, normalisation: Any) -> LinearLayer:
    weights = _to_array(module.weight).T.copy()
    bias = np.zeros(module.out_features, np.float32) if module.bias is None else _to_array(module.bias)
    if normalisation is None:
        return LinearLayer(weights, bias)
    factor = _to_array(normalisation.scale) / np.sqrt(_to_array(normalisation.ra_var) + normalisation.eps)
    shift = _to_array(normalisation.bias) - _to_array(normalisation.ra_mean) * factor
    bias = (bias + shift @ weights).astype(np.float32)
    return LinearLayer((weights * factor[:, None]).astype(np.float32), bias)


def _join_heads(means: PolicyNetwork, log_deviations: PolicyNetwork) -> PolicyNetwork:
    """One network of two that differ in their last layer: it gives means, then logarithms of standard deviations."""
    one, other = means.layers[-1], log_deviations.layers[-1]
    joined = LinearLayer(
        np.concatenate((one.weights, other.weights), axis=1), np.concatenate((one.bias, other.bias))
    )
    return PolicyNetwork((*means.layers[:-1], joined), means.activation)


def _convert_lstm(lstm: Any) -> LstmLayer | None:
    if lstm is None:
        return None
    if lstm.num_layers != 1:
        raise TypeError("a recurrent network with more than one layer cannot be exported")
    return LstmLayer(
        LinearLayer(_to_array(lstm.weight_ih_l0).T.copy(), _to_array(lstm.bias_ih_l0)),
        LinearLayer(_to_array(lstm.weight_hh_l0).T.copy(), _to_array(lstm.bias_hh_l0)),
    )


def _average_quantiles(network: PolicyNetwork, quantiles: int) -> PolicyNetwork:
    """The mean of a value's quantiles is linear in the last layer, so that layer can give it at once."""
    last = network.layers[-1]
    weights = last.weights.reshape(len(last.weights), quantiles, -1).mean(axis=1)
    bias = last.bias.reshape(quantiles, -1).mean(axis=0)
    return PolicyNetwork((*network.layers[:-1], LinearLayer(weights, bias)), network.activation)


def _to_array(parameter: Any) -> Float32Array:
    array: Float32Array = parameter.detach().cpu().numpy().astype(np.float32).copy()
    return array
