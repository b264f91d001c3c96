/** Changes of a scenario's text that leave everything else as it stands, comments included. */
import { isList, isMapping, items, pairs, parsed, parts, root } from "./tree.js";

/** The change { from, to, insert } that puts a value (YAML on one line) at a path. An editor has a tree of the text already. */
export function setting(text, path, value, tree = parsed(text)) {
  let node = root(tree);
  const keys = parts(path);
  for (let depth = 0; depth < keys.length; depth += 1) {
    if (isList(node)) {
      node = items(node)[keys[depth]];
      continue;
    }
    if (!isMapping(node)) return replaced(node, flow(keys.slice(depth), value));
    const pair = pairs(text, node).find((one) => one.key === keys[depth]);
    if (!pair) return added(text, node, `${keys[depth]}: ${flow(keys.slice(depth + 1), value)}`, depth);
    if (!pair.value) return { from: pair.node.to, to: pair.node.to, insert: ` ${flow(keys.slice(depth + 1), value)}` };
    node = pair.value;
  }
  return replaced(node, value);
}

/** The change that takes a key out; null where the text does not have it. */
export function removing(text, path) {
  const keys = parts(path);
  const last = keys.pop();
  let node = root(parsed(text));
  for (const key of keys) {
    node = isMapping(node) ? pairs(text, node).find((pair) => pair.key === key)?.value : null;
  }
  const pair = isMapping(node) ? pairs(text, node).find((one) => one.key === last) : null;
  if (!pair) return null;
  return node.name === "FlowMapping" ? outOfFlow(text, node, pair.node) : outOfBlock(text, node, pair.node);
}

/** The text after a change. */
export function changed(text, change) {
  return change ? text.slice(0, change.from) + change.insert + text.slice(change.to) : text;
}

function replaced(node, insert) {
  return node ? { from: node.from, to: node.to, insert } : { from: 0, to: 0, insert: "" };
}

/** The keys around a value as flow mappings: ["contact", "stiffness"] and 5 give {contact: {stiffness: 5}}. */
function flow(keys, value) {
  return keys.reduceRight((inner, key) => `{${key}: ${inner}}`, value);
}

function added(text, mapping, pair, depth) {
  if (mapping.name === "FlowMapping") {
    const end = mapping.to - 1;
    const empty = pairs(text, mapping).length === 0;
    const before = text.slice(0, end).trimEnd().length;
    return { from: before, to: end, insert: empty ? pair : `, ${pair}` };
  }
  const all = pairs(text, mapping);
  const checks = depth === 0 ? all.find((one) => one.key === "checks") : null;
  if (checks) return { from: checks.node.from, to: checks.node.from, insert: `${pair}\n\n` };
  const last = all[all.length - 1].node;
  const line = text.indexOf("\n", last.to);
  const place = line < 0 ? text.length : line;
  return { from: place, to: place, insert: `\n${" ".repeat(column(text, all[0].node.from))}${pair}` };
}

function outOfFlow(text, mapping, pair) {
  const after = /^\s*,\s*/.exec(text.slice(pair.to, mapping.to));
  if (after) return { from: pair.from, to: pair.to + after[0].length, insert: "" };
  const before = /,\s*$/.exec(text.slice(mapping.from, pair.from));
  return { from: pair.from - (before ? before[0].length : 0), to: pair.to, insert: "" };
}

function outOfBlock(text, mapping, pair) {
  if (pairs(text, mapping).length === 1) return { from: mapping.from, to: mapping.to, insert: "{}" };
  const from = pair.from - column(text, pair.from);
  const line = text.indexOf("\n", pair.to);
  return { from, to: line < 0 ? text.length : line + 1, insert: "" };
}

function column(text, place) {
  return place - (text.lastIndexOf("\n", place - 1) + 1);
}
