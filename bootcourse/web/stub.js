// The front end of every world in a notebook. The module itself, 0.3 MB, is in one other widget for all of them.
const modules = (globalThis.bootcourseWorlds ??= {});
export default {
  async render(context) {
    const reference = context.model.get("library").replace("IPY_MODEL_", "");
    const library = await context.model.widget_manager.get_model(reference), name = library.get("name");
    const address = () => URL.createObjectURL(new Blob([library.get("text")], { type: "text/javascript" }));
    return (await (modules[name] ??= import(address()))).show(context);
  },
};
