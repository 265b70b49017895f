"""Networks of torch as plain arrays (needs the extra ``learn``)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from kit.arrays import Float32Array
from kit.learning.policies.policy import (
    ActionSampling,
    Policy,
    PolicyError,
    SamplingKind,
    action_counts,
    check_network,
    task_interface,
)
from kit.learning.policies.policy_network import (
    Activation,
    LinearLayer,
    LstmLayer,
    PolicyNetwork,
    average_quantiles,
    join_heads,
)
from kit.learning.tasks.task_spec import TaskSpec

UNCHANGED = (nn.Flatten, nn.Identity, nn.Dropout)
"""Modules that change nothing of one row of numbers while a policy acts."""
BETWEEN: Mapping[type[nn.Module], Activation] = {nn.Tanh: "tanh", nn.ReLU: "relu"}
TRIED = 256
"""Observations on which an exported policy is compared with what it was made of."""
SAME_SHARE = 0.99
"""This many of them must lead to the same action: two actions may be as good as each other to the last digit."""
TOLERANCE = 1e-3


def export_policy(model: Any, task: Path | str) -> Policy:
    """Makes a policy of the kit's of what was trained elsewhere on a task, by its name or file: it can be saved, evaluated,
    watched, raced and exported as any other.

    ``model``: a model of stable-baselines3 or sb3-contrib, or a torch module of linear layers with tanh or ReLU between
    them, as modules or functions, which gives (n, actions) scores of (n, numbers) observations, or (n, numbers) continuous actions. What was made is
    tried beside the model before it is returned.

    Raises PolicyError if the model is of an unknown kind, or does not fit the task.

    >>> import torch
    >>> actor = torch.nn.Sequential(torch.nn.Linear(9, 32), torch.nn.Tanh(), torch.nn.Linear(32, 3))
    >>> kit.save_policy(kit.export_policy(actor, "turn"), "mine.npz")
    """
    spec = TaskSpec(str(task)).frozen()
    resolved = spec.resolve()
    choices = action_counts(resolved.actions.space(resolved.robots))
    space = resolved.observation.space(resolved.robots)
    seen = np.random.default_rng(0).uniform(space.low, space.high, (TRIED, *space.shape)).astype(np.float32)
    try:
        if isinstance(model, nn.Module):
            policy = _policy_of_module(model, choices, spec, task_interface(resolved), seen)
        elif hasattr(model, "policy") and hasattr(model, "predict"):
            network = export_network(model)
            check_network(network, resolved)
            policy = Policy(
                network,
                choices,
                export_sampling(model),
                spec,
                int(model.num_timesteps),
                task_interface(resolved),
                export_critic(model),
            )
        else:
            raise TypeError(
                f"a {type(model).__name__} is neither a model of stable-baselines3 nor a torch module"
            )
        policy.check_fits(resolved)
        policy.check_consistent()
    except (TypeError, ValueError, IndexError, AttributeError) as error:
        raise PolicyError(
            f"this {type(model).__name__} cannot be a policy of task {resolved.name}: {error}"
        ) from None
    _check_same(policy, model, seen)
    return policy


def _policy_of_module(
    module: nn.Module,
    choices: tuple[int, ...],
    spec: TaskSpec,
    interface: Mapping[str, Any],
    seen: Float32Array,
) -> Policy:
    parts, scores = _called_by(module, seen)
    if unknown := [each for each in parts if not isinstance(each, (nn.Linear, *BETWEEN))]:
        raise TypeError(f"it has a {type(unknown[0]).__name__}; the kit reads Linear, Tanh and ReLU")
    if not any(isinstance(each, nn.Linear) for each in parts):
        raise TypeError("it has no linear layer")
    ends = type(parts[-1])
    inner = {BETWEEN[type(each)] for each in parts[:-1] if type(each) in BETWEEN}
    if len(inner) > 1 or ends is nn.ReLU or (ends is nn.Tanh and choices):
        raise TypeError(
            "between its layers must lie Tanh or ReLU, everywhere the same, and nothing after the last"
        )
    network = convert_modules(parts)
    if not inner:  # functions may lie between the layers, which are no modules: what comes out tells which
        network.check_shapes()
        tried = [replace(network, activation=each) for each in BETWEEN.values()]
        memory = np.zeros((len(seen), 2, 0), np.float32)
        network = min(tried, key=lambda each: float(np.abs(each.scores(seen, memory)[0] - scores).max()))
    if choices:
        sampling = ActionSampling("softmax")
    else:
        kind: SamplingKind = "noisy-tanh" if ends is nn.Tanh else "normal"
        sampling = ActionSampling(kind, 1.0, (0.0,) * network.outputs)
    return Policy(network, choices, sampling, spec, 0, interface)


def _called_by(module: nn.Module, seen: Float32Array) -> tuple[list[nn.Module], Float32Array]:
    """The modules that the module calls for what is ``seen`` (n, numbers), in that order, but for those that change nothing; and
    what it gives (n, outputs). A critic beside the actor is left out, a Tanh that is called twice comes twice."""
    called: list[nn.Module] = []
    inner = [
        each for each in module.modules() if not list(each.children()) and not isinstance(each, UNCHANGED)
    ]
    hooks = [each.register_forward_hook(lambda part, *_: called.append(part)) for each in inner]
    try:
        found = _outputs_of(module, seen)
    finally:
        for hook in hooks:
            hook.remove()
    if not isinstance(found, torch.Tensor) or found.ndim != 2 or len(found) != len(seen):
        raise TypeError(
            f"for {len(seen)} observations it must return one tensor, a row for each. Of an actor-critic, give the actor alone"
        )
    return called, _to_array(found)


def _outputs_of(module: nn.Module, seen: Float32Array) -> Any:
    """What the module gives for (n, numbers). TypeError where it does not take this many numbers."""
    was_training = module.training
    module.eval()
    try:
        with torch.no_grad():
            return module(torch.as_tensor(seen))
    except RuntimeError as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise TypeError(
            f"it does not take the {seen.shape[1]} numbers of an observation ({reason})"
        ) from None
    finally:
        module.train(was_training)


def _check_same(policy: Policy, model: Any, seen: Float32Array) -> None:
    """PolicyError unless the policy does what the model does for what is ``seen`` (n, numbers)."""
    player = policy.make_player(len(seen))
    ours = player.act(seen)
    if isinstance(model, nn.Module):
        found = _outputs_of(model, seen)
        theirs = found.cpu().numpy() if policy.choices else found.clamp(-1, 1).cpu().numpy()
        ours = player.scores if policy.choices else ours
        is_same = np.isclose(ours, theirs, rtol=TOLERANCE, atol=TOLERANCE).mean()
    else:
        theirs = model.predict(seen, deterministic=True)[0]
        is_same = np.isclose(ours, theirs.reshape(ours.shape), rtol=TOLERANCE, atol=TOLERANCE).mean()
    if is_same < SAME_SHARE:
        raise PolicyError(
            f"what was exported does something else for {1.0 - is_same:.0%} of the numbers: between the layers, or before or after "
            "them, lies something that the kit does not know."
        )


def export_network(model: Any) -> PolicyNetwork:
    """Converts the network that chooses a stable-baselines3 or sb3-contrib model's actions. TypeError for an unknown kind."""
    policy = model.policy
    if hasattr(policy, "q_net"):
        return convert_modules(policy.q_net.q_net)
    if hasattr(policy, "quantile_net"):
        return average_quantiles(
            convert_modules(policy.quantile_net.quantile_net), policy.quantile_net.n_quantiles
        )
    if hasattr(policy, "actor") and hasattr(policy.actor, "latent_pi"):
        actor = policy.actor
        means, log_deviations = (
            convert_modules([*actor.latent_pi, head]) for head in (actor.mu, actor.log_std)
        )
        return join_heads(means, log_deviations)
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
    return average_quantiles(first, critic.n_quantiles) if hasattr(critic, "n_quantiles") else first


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
    normalisation: Any = None
    for module in modules:
        if isinstance(module, nn.Linear):
            layers.append(_convert_linear(module, normalisation))
            normalisation = None
        elif type(module) in BETWEEN:
            activations.append(BETWEEN[type(module)])
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


def _convert_lstm(lstm: Any) -> LstmLayer | None:
    if lstm is None:
        return None
    if lstm.num_layers != 1:
        raise TypeError("a recurrent network with more than one layer cannot be exported")
    return LstmLayer(
        LinearLayer(_to_array(lstm.weight_ih_l0).T.copy(), _to_array(lstm.bias_ih_l0)),
        LinearLayer(_to_array(lstm.weight_hh_l0).T.copy(), _to_array(lstm.bias_hh_l0)),
    )


def _to_array(parameter: Any) -> Float32Array:
    array: Float32Array = parameter.detach().cpu().numpy().astype(np.float32).copy()
    return array
